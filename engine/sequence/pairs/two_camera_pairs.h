#pragma once

#include <array>
#include <exception>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "engine/sequence/pairs/frame_pairing.h"
#include "engine/sequence/pairs/pair_source.h"

namespace vantage {

/// Pairs of the frames of two cameras.
class TwoCameraPairs final : public PairSource {
 public:
  /// `pairing`: of these two, and maybe of more cameras.
  TwoCameraPairs(std::unique_ptr<FrameSource> left, std::unique_ptr<FrameSource> right,
                 FramePairing pairing);

  /// Of all pairs, from a list.
  void set_details(std::vector<PairDetails> details) { details_ = std::move(details); }

  [[nodiscard]] const FramePairing& frames() const { return pairing_; }

  bool fetch(FramePair& pair) override;
  void skip_to(int index) override;
  [[nodiscard]] int pair_count() const override { return pairing_.count; }
  [[nodiscard]] PairDetails details(int index) const override {
    return details_.empty() ? PairDetails{} : details_.at(static_cast<std::size_t>(index));
  }
  [[nodiscard]] int frame_of(std::size_t camera, int index) const override {
    return pairing_.frame(camera, index);
  }
  [[nodiscard]] std::string describe(int index) const override;
  [[nodiscard]] std::vector<std::string> remarks() const override { return pairing_.remarks; }
  [[nodiscard]] Pairing pairing() const override { return pairing_.found; }
  [[nodiscard]] std::optional<FrameRate> frame_rate() const override;
  [[nodiscard]] std::optional<FrameTimes> frame_times() const override;
  [[nodiscard]] FilmFormat film_format() const override { return cameras_[0]->film_format(); }
  [[nodiscard]] Sound sound() const override;
  [[nodiscard]] std::vector<std::filesystem::path> files() const override;
  [[nodiscard]] std::vector<std::string> identities() const override;

 private:
  /// Fetches the frame of the next pair even if that of the other camera was bad; keeps the first
  /// problem.
  bool fetch_of(std::size_t camera, FetchedFrame& frame, std::exception_ptr& problem);
  /// The camera whose times are those of the pairs.
  [[nodiscard]] std::size_t timing_camera() const { return cameras_[0]->frame_rate() ? 0 : 1; }

  std::array<std::unique_ptr<FrameSource>, 2> cameras_;
  FramePairing pairing_;
  std::vector<PairDetails> details_;           // empty, or of all pairs
  std::array<int, 2> next_frames_ = {-1, -1};  // of fetch(); −1: not known
  int next_index_ = 0;
};

}  // namespace vantage
