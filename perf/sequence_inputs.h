#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/execution.h"
#include "engine/generation/layered_scene.h"
#include "engine/image/stereo_packing.h"
#include "engine/io/images/photograph_io.h"
#include "engine/io/video/video_io.h"
#include "engine/sequence/pairs/pair_source.h"

namespace vantage::perf {

/// One sequence in two forms, and as files for other readers.
struct SequenceInputs {
  std::string name;
  PairSourceOptions images;  ///< a folder of PNG files per camera
  PairSourceOptions video;   ///< one packed MP4
  std::vector<std::array<std::filesystem::path, 2>> image_pairs;
  std::filesystem::path video_file;
};

inline SequenceInputs sequence_inputs(std::string name, const std::filesystem::path& left,
                                      const std::filesystem::path& right,
                                      const std::filesystem::path& video) {
  SequenceInputs inputs;
  inputs.name = std::move(name);
  inputs.video_file = video;
  inputs.images.left = left.string();
  inputs.images.right = right.string();
  inputs.video.stereo = video.string();
  inputs.video.packing = StereoPacking{};
  for (const auto& entry : std::filesystem::directory_iterator(left)) {
    inputs.image_pairs.push_back({entry.path(), right / entry.path().filename()});
  }
  std::sort(inputs.image_pairs.begin(), inputs.image_pairs.end());
  return inputs;
}

/// A synthetic sequence of the same size, for when the real one is not available; files go to
/// `folder`.
inline SequenceInputs generate_sequence(const std::filesystem::path& folder) {
  constexpr int kFrames = 24;
  LayeredSceneOptions options;
  options.width_px = 1226;
  options.height_px = 370;
  options.samples_per_side = 1;
  options.near_disparity_px = 75;
  options.far_disparity_px = 2;
  options.noise_sigma = 2;
  Execution execution({});
  const LayeredScene scene(options, execution);
  const std::array<std::filesystem::path, 2> folders = {folder / "left", folder / "right"};
  const std::filesystem::path video = folder / "packed.mp4";
  VideoWriter writer(video, 2 * options.width_px, options.height_px, {});
  Photograph packed;
  for (int frame = 0; frame < kFrames; ++frame) {
    const std::array<Photograph, 2> pair = {scene.render({0, 0}, frame).image,
                                            scene.render({1, 0}, frame).image};
    for (std::size_t side = 0; side < 2; ++side) {
      std::filesystem::create_directories(folders[side]);
      write_photograph(folders[side] / fmt::format("{:06}.png", frame), pair[side]);
    }
    pack_stereo(pair[0], pair[1], {}, packed);
    writer.write(packed);
  }
  writer.finish();
  return sequence_inputs("generated, 1226x370", folders[0], folders[1], video);
}

/// Repeats a sequence, so that a short one behaves like a long one. Calls `on_fetch` with each
/// requested pair.
class RepeatedPairs final : public PairSource {
 public:
  RepeatedPairs(const PairSourceOptions& options, int pair_count,
                std::function<void(int index)> on_fetch)
      : source_(open_pair_source(options)),
        pair_count_(pair_count),
        on_fetch_(std::move(on_fetch)) {}

  bool fetch(FramePair& pair) override {
    on_fetch_(next_index_);
    if (next_index_ == pair_count_) {
      return false;
    }
    if (next_index_ % source_->pair_count() == 0) {
      source_->skip_to(0);
    }
    ++next_index_;
    return source_->fetch(pair);
  }
  void skip_to(int index) override {
    next_index_ = index;
    source_->skip_to(index % source_->pair_count());
  }
  [[nodiscard]] int pair_count() const override { return pair_count_; }
  [[nodiscard]] std::string describe(int index) const override {
    return source_->describe(index % source_->pair_count());
  }
  [[nodiscard]] std::vector<std::string> remarks() const override { return {}; }
  [[nodiscard]] std::optional<FrameRate> frame_rate() const override {
    return source_->frame_rate();
  }
  [[nodiscard]] Sound sound() const override { return {}; }
  [[nodiscard]] std::vector<std::filesystem::path> files() const override { return {}; }
  [[nodiscard]] std::vector<std::string> identities() const override {
    return source_->identities();
  }

 private:
  void make_images(FramePair& pair) const override { source_->decode(pair); }
  std::unique_ptr<PairSource> source_;
  int pair_count_;
  std::function<void(int index)> on_fetch_;
  int next_index_ = 0;
};

}  // namespace vantage::perf
