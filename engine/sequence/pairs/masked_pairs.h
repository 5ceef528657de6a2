#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "engine/image/scene_mask.h"
#include "engine/sequence/pairs/pair_source.h"

namespace vantage {

/// The pairs of another source, without the pixels that show no scene (leave_out_of_pair()). Masks
/// of files belong to pairs by their index in the input. Black borders are those of pairs from the
/// beginning of the input together, whichever pairs are fetched; `each_alone`: of each pair.
class MaskedPairs final : public PairSource {
 public:
  /// Throws Error when masks cannot be opened, or are neither one nor as many as the pairs.
  MaskedPairs(std::unique_ptr<PairSource> source, SceneMaskOptions options, bool each_alone);

  bool fetch(FramePair& pair) override;
  void skip_to(int index) override {
    next_index_ = index;
    source_->skip_to(index);
  }
  [[nodiscard]] int pair_count() const override { return source_->pair_count(); }
  [[nodiscard]] bool is_stream() const override { return source_->is_stream(); }
  [[nodiscard]] FrameRange repeatable_pairs() const override { return source_->repeatable_pairs(); }
  void forget_start() override { source_->forget_start(); }
  [[nodiscard]] FrameRange pairs_of(FrameRange input_frames) const override {
    return source_->pairs_of(input_frames);
  }
  [[nodiscard]] const WhiteLevel& white_level() const override { return source_->white_level(); }
  [[nodiscard]] int index_of(int pair) const override { return source_->index_of(pair); }
  [[nodiscard]] int input_frames() const override { return source_->input_frames(); }
  [[nodiscard]] int frames_kept() const override { return source_->frames_kept(); }
  [[nodiscard]] PairDetails details(int index) const override { return source_->details(index); }
  [[nodiscard]] std::string describe(int index) const override { return source_->describe(index); }
  [[nodiscard]] std::vector<std::string> remarks() const override { return source_->remarks(); }
  [[nodiscard]] int unpaired_frames() const override { return source_->unpaired_frames(); }
  [[nodiscard]] std::optional<FrameRate> frame_rate() const override {
    return source_->frame_rate();
  }
  [[nodiscard]] std::optional<FrameTimes> frame_times() const override {
    return source_->frame_times();
  }
  [[nodiscard]] Sound sound() const override { return source_->sound(); }
  [[nodiscard]] std::vector<std::filesystem::path> files() const override;
  [[nodiscard]] std::vector<std::string> identities() const override;

 private:
  void make_images(FramePair& pair) const override;
  void find_borders();

  std::unique_ptr<PairSource> source_;
  SceneMaskOptions options_;
  std::array<std::unique_ptr<FrameSource>, 2> masks_;  ///< null: none
  bool needs_borders_;                                 ///< they are still to be found
  bool each_alone_;
  std::array<Mask, 2> borders_;
  int next_index_ = 0;
};

}  // namespace vantage
