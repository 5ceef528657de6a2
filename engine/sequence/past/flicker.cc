#include "engine/sequence/past/flicker.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <utility>
#include <variant>

#include "engine/error.h"
#include "engine/sequence/past/still_pixels.h"
#include "kernels/flicker_sums/flicker_sums.h"
#include "kernels/still_pixels/still_pixels.h"

namespace vantage {
namespace {

constexpr std::int64_t kUnits = 1024;  // per pixel of disparity, per grey level of brightness

double ratio(std::int64_t sum, std::int64_t count) {
  return count == 0 ? 0 : static_cast<double>(sum) / static_cast<double>(count);
}

/// Grey levels of one image of a frame, with their sum.
struct Levels {
  Image<std::uint8_t> levels;
  std::int64_t sum = 0;

  void take(const Photograph& image, Execution& execution) {
    luma_intensity(image, execution, levels);
    std::atomic<std::int64_t> total = 0;
    execution.for_each_band(levels.height(), [&](int first_row, int end_row) {
      std::int64_t of_band = 0;
      for (int y = first_row; y < end_row; ++y) {
        of_band += kernels::intensity_sum_row(levels.row(y), levels.width());
      }
      total += of_band;
    });
    sum = total;
  }
};

/// All data compared of one frame.
struct Frame {
  Levels left;
  DisparityMap map;  ///< empty: none
  std::vector<ViewPose> poses;
  std::vector<Levels> views;

  void take(const Photograph& left_image, ImageView<const float> left_map,
            std::span<const ViewOfFrame> frame_views, Execution& execution) {
    left.take(left_image, execution);
    map.resize(left_map.width(), left_map.height());
    for (int y = 0; y < left_map.height(); ++y) {
      std::copy_n(left_map.row(y), left_map.width(), map.row(y));
    }
    poses.resize(frame_views.size());
    views.resize(frame_views.size());
    for (std::size_t v = 0; v < views.size(); ++v) {
      poses[v] = frame_views[v].pose;
      views[v].take(*frame_views[v].image, execution);
    }
  }
  [[nodiscard]] int width() const { return left.levels.width(); }
  [[nodiscard]] int height() const { return left.levels.height(); }
  [[nodiscard]] bool is_comparable_with(const Frame& other) const {
    return width() == other.width() && height() == other.height() &&
           map.empty() == other.map.empty() && views.size() == other.views.size();
  }
};

void require_sizes(const Photograph& left, ImageView<const float> left_map,
                   std::span<const ViewOfFrame> views) {
  const auto require = [&](const char* what, int width, int height) {
    if (width != left.width() || height != left.height()) {
      throw Error(fmt::format("{} is {}x{}, expected {}x{} as the left image", what, width, height,
                              left.width(), left.height()));
    }
  };
  if (!left_map.empty()) {
    require("left disparity map", left_map.width(), left_map.height());
  }
  for (const ViewOfFrame& view : views) {
    if (std::holds_alternative<BaselinePosition>(view.pose)) {
      require("new view", view.image->width(), view.image->height());
    }
  }
}

}  // namespace

void ViewFlickerSums::add(const ViewFlickerSums& other) {
  compared += other.compared;
  grey_change += other.grey_change;
  brightness_jump += other.brightness_jump;
}

double ViewFlickerSums::mean_grey_change() const { return ratio(grey_change, compared); }

double ViewFlickerSums::mean_brightness_jump(std::int64_t frames) const {
  return ratio(brightness_jump, frames * kUnits);
}

void FlickerSums::add(const FlickerSums& other) {
  if (!views.empty() && !other.views.empty() && views.size() != other.views.size()) {
    throw Error(fmt::format("flicker sums are of {} views, expected {} as before",
                            other.views.size(), views.size()));
  }
  frames += other.frames;
  pixels += other.pixels;
  still += other.still;
  grey_change += other.grey_change;
  compared += other.compared;
  jumped += other.jumped;
  disparity_change += other.disparity_change;
  views.resize(std::max(views.size(), other.views.size()));
  for (std::size_t v = 0; v < other.views.size(); ++v) {
    views[v].add(other.views[v]);
  }
}

void FlickerSums::clear(std::size_t view_count) {
  const auto no_view = ViewFlickerSums{};
  std::vector<ViewFlickerSums> kept = std::move(views);
  kept.assign(view_count, no_view);
  *this = {};
  views = std::move(kept);
}

double FlickerSums::mean_disparity_change_px() const {
  return ratio(disparity_change, compared * kUnits);
}
double FlickerSums::share_jumped() const { return ratio(jumped, compared); }
double FlickerSums::share_compared() const { return ratio(compared, pixels); }
double FlickerSums::mean_grey_change() const { return ratio(grey_change, still); }

struct FlickerMeter::State {
  explicit State(double threshold) : still_pixels(threshold) {}

  /// Sums over one row; `still_view` is working memory of the row's width.
  void add_row(int y, std::uint8_t* still_view, FlickerSums& sums) const {
    const int width = now.width();
    const std::uint8_t* is_still = still.row(y);
    const kernels::IntensityChange left = kernels::intensity_change_row(
        now.left.levels.row(y), before.left.levels.row(y), is_still, width);
    sums.still += left.compared;
    sums.grey_change += left.change;
    // Without maps it is unknown which of a view's pixels show moving surfaces.
    if (now.map.empty()) {
      return;
    }
    const kernels::DisparityChange map =
        kernels::disparity_change_row(now.map.row(y), before.map.row(y), is_still, width);
    sums.compared += map.compared;
    sums.jumped += map.jumped;
    sums.disparity_change += map.change;
    if (!(map.min_px <= map.max_px)) {
      return;
    }
    for (std::size_t v = 0; v < sums.views.size(); ++v) {
      // Off the baseline the rows do not correspond.
      const auto* position = std::get_if<BaselinePosition>(&now.poses[v]);
      if (!has_same_camera(v) || position == nullptr || position->y != 0) {
        continue;
      }
      // (3.5): a view's pixel at x was at x + XS · d in the left image.
      const double first = position->x * map.min_px;
      const double second = position->x * map.max_px;
      kernels::still_view_row(is_still, width,
                              static_cast<int>(std::floor(std::min(first, second))),
                              static_cast<int>(std::ceil(std::max(first, second))), still_view);
      const kernels::IntensityChange view = kernels::intensity_change_row(
          now.views[v].levels.row(y), before.views[v].levels.row(y), still_view, width);
      sums.views[v].compared += view.compared;
      sums.views[v].grey_change += view.change;
    }
  }

  [[nodiscard]] bool has_same_camera(std::size_t view) const {
    return now.poses[view] == before.poses[view];
  }
  /// Difference of the means over all pixels, in units.
  [[nodiscard]] std::int64_t brightness_jump(std::size_t view) const {
    if (!has_same_camera(view)) {
      return 0;
    }
    const std::int64_t pixels = static_cast<std::int64_t>(now.width()) * now.height();
    const Image<std::uint8_t>& levels = now.views[view].levels;
    // Scaled as if the view had the size of the left image.
    const double scale = static_cast<double>(pixels) /
                         static_cast<double>(std::int64_t{levels.width()} * levels.height());
    const std::int64_t of_view =
        std::llround(scale * static_cast<double>(now.views[view].sum - before.views[view].sum));
    const std::int64_t of_left = now.left.sum - before.left.sum;
    return (std::abs(of_view - of_left) * kUnits + pixels / 2) / pixels;
  }

  StillPixels still_pixels;
  bool has_before = false;
  Frame now;
  Frame before;
  Mask still;
  std::vector<FlickerSums> of_rows;
};

FlickerMeter::FlickerMeter(double threshold) : state_(std::make_unique<State>(threshold)) {}
FlickerMeter::~FlickerMeter() = default;
FlickerMeter::FlickerMeter(FlickerMeter&&) noexcept = default;
FlickerMeter& FlickerMeter::operator=(FlickerMeter&&) noexcept = default;

void FlickerMeter::restart() { state_->has_before = false; }

FlickerSums FlickerMeter::add(const Photograph& left, ImageView<const float> left_map,
                              std::span<const ViewOfFrame> views, Execution& execution) {
  require_sizes(left, left_map, views);
  State& state = *state_;
  std::swap(state.now, state.before);
  state.now.take(left, left_map, views, execution);
  FlickerSums sums;
  sums.views.resize(views.size());
  if (!std::exchange(state.has_before, true) || !state.now.is_comparable_with(state.before)) {
    return sums;
  }
  const int width = state.now.width();
  const int height = state.now.height();
  state.still_pixels.find(state.before.left.levels, state.now.left.levels, execution, state.still);
  // Indexed by the first rows of bands; the rest stays empty.
  state.of_rows.resize(static_cast<std::size_t>(height));
  execution.for_each_band(height, [&](int first_row, int end_row) {
    const auto memory = execution.scratch().lease(static_cast<std::size_t>(width));
    FlickerSums& of_band = state.of_rows[static_cast<std::size_t>(first_row)];
    of_band.clear(views.size());
    for (int y = first_row; y < end_row; ++y) {
      state.add_row(y, reinterpret_cast<std::uint8_t*>(memory.data()), of_band);
    }
  });
  for (const FlickerSums& of_band : state.of_rows) {
    sums.add(of_band);
  }
  sums.frames = 1;
  sums.pixels = static_cast<std::int64_t>(width) * height;
  for (std::size_t v = 0; v < views.size(); ++v) {
    sums.views[v].brightness_jump = state.brightness_jump(v);
  }
  return sums;
}

}  // namespace vantage
