#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "engine/execution.h"
#include "engine/image/image.h"
#include "engine/image/photograph.h"
#include "engine/view_geometry/view_pose.h"

namespace vantage {

/// Flicker of one new view, as sums; see FlickerSums. Frames whose views have different poses are
/// not compared.
struct ViewFlickerSums {
  /// Pixels of the view that can only show surfaces whose left image did not change.
  std::int64_t compared = 0;
  std::int64_t grey_change = 0;  ///< Σ |V_t − V_{t−1}| over them, in grey levels
  /// Σ over frames of |change of the view's mean − change of the left image's mean|, in 1/1024 grey
  /// level.
  std::int64_t brightness_jump = 0;

  void add(const ViewFlickerSums& other);
  /// Means; 0 if nothing was compared. `frames`: FlickerSums::frames.
  [[nodiscard]] double mean_grey_change() const;
  [[nodiscard]] double mean_brightness_jump(std::int64_t frames) const;
  friend bool operator==(const ViewFlickerSums&, const ViewFlickerSums&) = default;
};

/// Change of the results from frame to frame where the left image did not change (StillPixels):
/// flicker plus image noise, which is not subtracted. Sums over frames; all integers, so that the
/// order of summation does not matter.
struct FlickerSums {
  std::int64_t frames = 0;            ///< frames with a predecessor in their chunk
  std::int64_t pixels = 0;            ///< of those frames
  std::int64_t still = 0;             ///< of them: the left image did not change
  std::int64_t grey_change = 0;       ///< Σ |L_t − L_{t−1}| over these, in grey levels
  std::int64_t compared = 0;          ///< of these: both disparities are known
  std::int64_t jumped = 0;            ///< of these: the disparity changed by more than 1 px
  std::int64_t disparity_change = 0;  ///< Σ |d_t − d_{t−1}| over the compared ones, in 1/1024 px
  std::vector<ViewFlickerSums> views;

  /// Throws Error when both have views but in different numbers.
  void add(const FlickerSums& other);
  /// Sets all to 0, with `view_count` views; keeps the memory.
  void clear(std::size_t view_count);
  /// Means and shares; 0 if nothing was compared.
  [[nodiscard]] double mean_disparity_change_px() const;
  [[nodiscard]] double share_jumped() const;
  [[nodiscard]] double share_compared() const;
  [[nodiscard]] double mean_grey_change() const;  ///< of the left image
  friend bool operator==(const FlickerSums&, const FlickerSums&) = default;
};

/// One new view of a frame.
struct ViewOfFrame {
  ViewPose pose;
  const Photograph* image = nullptr;
};

/// Compares consecutive frames of a chunk. Memory is reused from frame to frame. Thread rule: one
/// call at a time.
class FlickerMeter {
 public:
  /// `threshold`: of StillPixels. Throws UsageError.
  explicit FlickerMeter(double threshold);
  ~FlickerMeter();
  FlickerMeter(FlickerMeter&&) noexcept;
  FlickerMeter& operator=(FlickerMeter&&) noexcept;

  /// The next frame has no predecessor.
  void restart();

  /// Contribution of this frame: 0 (with the same number of views) for the first one, and if the
  /// size of the images or the number of views changes. left_map: on the left grid, NaN = unknown;
  /// empty: there is none, and no pixel of a view is compared, because its source is unknown;
  /// neither are pixels of views off the baseline. Throws Error unless maps and views at positions
  /// have the size of the image. Grey levels are luma, rounded. Identical for any `execution`.
  FlickerSums add(const Photograph& left, ImageView<const float> left_map,
                  std::span<const ViewOfFrame> views, Execution& execution);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace vantage
