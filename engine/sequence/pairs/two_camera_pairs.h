#pragma once

#include <exception>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "engine/sequence/pairs/pair_source.h"

namespace vantage {

/// Pairs of the frames of two cameras, by index.
class TwoCameraPairs final : public PairSource {
 public:
  /// Frame i + offset_frames of `right` belongs to frame i of `left`. `numbers_matter`: remarks()
  /// checks the numbers in the file names. Throws Error when no frame has a partner.
  TwoCameraPairs(std::unique_ptr<FrameSource> left, std::unique_ptr<FrameSource> right,
                 int offset_frames, bool numbers_matter);

  /// Of all pairs, from a list.
  void set_details(std::vector<PairDetails> details) { details_ = std::move(details); }

  [[nodiscard]] const FrameSource& left() const { return *left_; }
  /// Frame of the left camera in pair 0.
  [[nodiscard]] int first_left() const { return first_left_; }

  bool fetch(FramePair& pair) override;
  void skip_to(int index) override;
  [[nodiscard]] int pair_count() const override { return pair_count_; }
  [[nodiscard]] PairDetails details(int index) const override {
    return details_.empty() ? PairDetails{} : details_.at(static_cast<std::size_t>(index));
  }
  [[nodiscard]] std::string describe(int index) const override;
  [[nodiscard]] std::vector<std::string> remarks() const override;
  [[nodiscard]] int unpaired_frames() const override;
  [[nodiscard]] std::optional<FrameRate> frame_rate() const override;
  [[nodiscard]] std::optional<FrameTimes> frame_times() const override;
  [[nodiscard]] FilmFormat film_format() const override { return left_->film_format(); }
  [[nodiscard]] Sound sound() const override;
  [[nodiscard]] std::vector<std::filesystem::path> files() const override;
  [[nodiscard]] std::vector<std::string> identities() const override;

 private:
  /// Fetches the right frame of the next pair, at the position of the left source.
  bool fetch_right(FetchedFrame& frame, std::exception_ptr& problem);
  /// Frames at the end of the left (right) source that have no partner.
  [[nodiscard]] int left_over() const { return left_->frame_count() - first_left_ - pair_count_; }
  [[nodiscard]] int right_over() const {
    return right_->frame_count() - first_right_ - pair_count_;
  }

  std::unique_ptr<FrameSource> left_;
  std::unique_ptr<FrameSource> right_;
  bool numbers_matter_;
  std::vector<PairDetails> details_;  // empty, or of all pairs
  int first_left_;                    // frame of pair 0
  int first_right_;
  int pair_count_;
  int next_index_ = 0;
  bool right_lags_ = false;  // it is still at the position after the last fetch() that wanted it
};

}  // namespace vantage
