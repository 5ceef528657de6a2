#include "engine/matching/region/matched_part.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <variant>

#include "engine/error.h"
#include "engine/image/left_out.h"
#include "engine/image/resized.h"
#include "kernels/map_enlargement/map_enlargement.h"

namespace vantage {
namespace {

using scheduler::Range;
using scheduler::Region;

/// Pixels around a region that its own pixels are aggregated with.
constexpr int kContextPx = 32;
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr std::uint8_t kUnmatched = 255;
constexpr std::uint8_t kLeftOut = 255;

int reduced(int pixels, double scale) {
  return std::max(1, static_cast<int>(std::lround(pixels * scale)));
}

DisparityRange reduced(DisparityRange range, double scale) {
  return {static_cast<int>(std::floor(range.min * scale)),
          static_cast<int>(std::ceil(range.max * scale))};
}

/// The numbers that partners of `pixels` have, at positions up to `range` times `factor` before
/// them, cut to `all`.
Range partners_of(Range pixels, DisparityRange range, double factor, Range all) {
  const double a = range.min * factor;
  const double b = range.max * factor;
  const Range partners{pixels.begin - static_cast<int>(std::ceil(std::max(a, b))),
                       pixels.end - static_cast<int>(std::floor(std::min(a, b)))};
  return {std::clamp(partners.begin, all.begin, all.end),
          std::clamp(partners.end, all.begin, all.end)};
}

template <typename T>
ImageView<T> cut(ImageView<T> image, const Region& pixels) {
  return {image.row(pixels.rows.begin) + pixels.columns.begin * image.channels(),
          pixels.columns.size(), pixels.rows.size(), image.channels(), image.stride()};
}

/// Linear within surfaces; at jumps a pixel takes the disparity of the one that covers it.
/// Values stay in `range`, which that of reduced pixels exceeds by rounding.
DisparityMap enlarged(const DisparityMap& map_px, scheduler::Extent extent, float px_per_px,
                      DisparityRange range) {
  DisparityMap result = resized_to_nearest<float>(map_px.view(), extent.columns, extent.rows);
  const DisparityMap linear = resized_linearly(map_px.view(), extent.columns, extent.rows);
  constexpr float kSurfacePx = 0.5F * kernels::kEnlargedSurfaceStepPx;
  for (int y = 0; y < extent.rows; ++y) {
    std::transform(result.row(y), result.row(y) + extent.columns, linear.row(y), result.row(y),
                   [&](float nearest, float between) {
                     const bool is_surface = std::abs(between - nearest) <= kSurfacePx;
                     return std::clamp(px_per_px * (is_surface ? between : nearest),
                                       static_cast<float>(range.min),
                                       static_cast<float>(range.max));
                   });
  }
  return result;
}

}  // namespace

ResolvedMatchOptions options_of_part(MatchOptions options) {
  const double scale = std::exchange(options.scale, 1);
  options.roi.reset();
  options.disparities = reduced(options.disparities, scale);
  if (options.disparities_y) {
    options.disparities_y = reduced(*options.disparities_y, scale);
  }
  return options.in_force();
}

MatchedPart::MatchedPart(const ResolvedMatchOptions& options, scheduler::Extent images,
                         std::span<const double> places, Side reference)
    : range_(options.disparities),
      range_y_(options.disparities_y.value_or(DisparityRange{0, 0})),
      images_(images) {
  const Region all{images.all_columns(), images.all_rows()};
  Region region = all;
  if (options.roi) {
    const auto [x, y, width, height] = *options.roi;
    region = {{x, x + width}, {y, y + height}};
    if (!all.columns.contains(region.columns) || !all.rows.contains(region.rows)) {
      throw Error(fmt::format("roi is {},{},{},{}, expected it inside the images of {}x{}", x, y,
                              width, height, images.columns, images.rows));
    }
  }
  cut_ = region;
  for (const double place : places) {
    const double direction = reference == Side::kLeft ? place : -place;
    const Region partners{partners_of(region.columns, options.disparities, direction, all.columns),
                          partners_of(region.rows, range_y_, direction, all.rows)};
    wanted_.push_back(partners);
    cut_ = {{std::min(cut_.columns.begin, partners.columns.begin),
             std::max(cut_.columns.end, partners.columns.end)},
            {std::min(cut_.rows.begin, partners.rows.begin),
             std::max(cut_.rows.end, partners.rows.end)}};
  }
  cut_ = {cut_.columns.widened(kContextPx, all.columns), cut_.rows.widened(kContextPx, all.rows)};
  extent_ = {reduced(cut_.columns.size(), options.scale), reduced(cut_.rows.size(), options.scale)};
}

Photograph MatchedPart::of(const Photograph& photograph) const {
  const bool is_smaller = extent_ != scheduler::Extent{cut_.columns.size(), cut_.rows.size()};
  const auto part_of = [&]<typename T>(const Image<T>& image) {
    const ImageView<const T> pixels = cut(image.view(), cut_);
    return is_smaller ? reduced_by_area<T>(pixels, extent_.columns, extent_.rows)
                      : Image<T>::borrowed(pixels);
  };
  Photograph result =
      std::visit([&](const auto& image) { return Photograph{part_of(image)}; }, photograph.pixels);
  if (!is_smaller) {
    result.origin = photograph.origin;
  }
  if (!photograph.left_out.empty()) {
    result.left_out = part_of(photograph.left_out);
  }
  if (is_smaller && !photograph.left_out.empty()) {
    // Of an area that is left out in part, the rest still shows the scene.
    for (int y = 0; y < extent_.rows; ++y) {
      std::uint8_t* const row = result.left_out.row(y);
      std::transform(row, row + extent_.columns, row, [](std::uint8_t share) -> std::uint8_t {
        return share == kLeftOut ? kLeftOut : 0;
      });
    }
  }
  return result;
}

DisparityMap MatchedPart::of_prior(ImageView<const float> map_px) const {
  DisparityMap result;
  if (!map_px.empty()) {
    result = resized_to_nearest<float>(cut(map_px, cut_), extent_.columns, extent_.rows);
    const auto scale =
        static_cast<float>(extent_.columns / static_cast<double>(cut_.columns.size()));
    for (int y = 0; y < extent_.rows; ++y) {
      std::transform(result.row(y), result.row(y) + extent_.columns, result.row(y),
                     [=](float disparity_px) { return disparity_px * scale; });
    }
  }
  return result;
}

void MatchedPart::bring_back(const MatchedMap& map_of_part, std::size_t index,
                             const Photograph& image, MatchedMap& map) const {
  const scheduler::Extent extent{cut_.columns.size(), cut_.rows.size()};
  const Region& wanted = wanted_[index];
  // The wanted pixels of `of_cut`, in the whole image.
  const auto place = [&]<typename T>(const Image<T>& of_cut, T unknown, Image<T>& whole) {
    whole.resize(of_cut.empty() ? 0 : images_.columns, of_cut.empty() ? 0 : images_.rows);
    whole.fill(unknown);
    for (int y = wanted.rows.begin; y < (of_cut.empty() ? 0 : wanted.rows.end); ++y) {
      std::copy_n(of_cut.row(y - cut_.rows.begin) + wanted.columns.begin - cut_.columns.begin,
                  wanted.columns.size(), whole.row(y) + wanted.columns.begin);
    }
  };
  const auto place_disparities = [&](const DisparityMap& of_part, double px_per_px,
                                     DisparityRange range, DisparityMap& whole) {
    place(of_part.empty() ? DisparityMap()
                          : enlarged(of_part, extent, static_cast<float>(px_per_px), range),
          kNaN, whole);
  };
  const auto place_nearest = [&]<typename T>(const Image<T>& of_part, T unknown, Image<T>& whole) {
    place(of_part.empty() ? Image<T>()
                          : resized_to_nearest<T>(of_part.view(), extent.columns, extent.rows),
          unknown, whole);
  };
  place_disparities(map_of_part.disparity_px, static_cast<double>(extent.columns) / extent_.columns,
                    range_, map.disparity_px);
  place_disparities(map_of_part.disparity_y_px, static_cast<double>(extent.rows) / extent_.rows,
                    range_y_, map.disparity_y_px);
  place_nearest(map_of_part.confidence, 0.0F, map.confidence);
  place_nearest(map_of_part.unmatched, kUnmatched, map.unmatched);
  erase_left_out(image.left_out, map);
}

}  // namespace vantage
