#include "engine/matching/region/matched_part.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <variant>
#include <vector>

#include "engine/error.h"
#include "engine/image/area_average.h"
#include "engine/image/intensity_rows.h"
#include "engine/image/left_out.h"
#include "kernels/map_enlargement/map_enlargement.h"

namespace vantage {
namespace {

using scheduler::Range;
using scheduler::Region;

/// Pixels around a region that its own pixels are aggregated with.
constexpr int kContextPx = 32;
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr std::uint8_t kUnmatched = 255;

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

/// The pixels of a shorter line around those of a line.
struct Neighbours {
  int near = 0;    ///< the one that covers the pixel
  int beside = 0;  ///< the other one
  float weight_beside = 0;
};

std::vector<Neighbours> neighbours_of(int pixels, int reduced_pixels) {
  const double ratio = static_cast<double>(reduced_pixels) / pixels;
  std::vector<Neighbours> result;
  for (int i = 0; i < pixels; ++i) {
    const double centre = (i + 0.5) * ratio - 0.5;
    const int near = std::clamp(static_cast<int>(std::floor(centre + 0.5)), 0, reduced_pixels - 1);
    const int beside = std::clamp(near + (centre < near ? -1 : 1), 0, reduced_pixels - 1);
    result.push_back(
        {near, beside, beside == near ? 0.0F : static_cast<float>(std::abs(centre - near))});
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
    : range_(options.disparities), range_y_(options.disparities_y), images_(images) {
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
    const Region partners{
        partners_of(region.columns, options.disparities, direction, all.columns),
        partners_of(region.rows, options.disparities_y.value_or(DisparityRange{0, 0}), direction,
                    all.rows)};
    wanted_.push_back(partners);
    cut_ = {{std::min(cut_.columns.begin, partners.columns.begin),
             std::max(cut_.columns.end, partners.columns.end)},
            {std::min(cut_.rows.begin, partners.rows.begin),
             std::max(cut_.rows.end, partners.rows.end)}};
  }
  cut_ = {cut_.columns.widened(kContextPx, all.columns), cut_.rows.widened(kContextPx, all.rows)};
  extent_ = {reduced(cut_.columns.size(), options.scale), reduced(cut_.rows.size(), options.scale)};
}

Photograph MatchedPart::of(const Photograph& photograph, Execution& execution) const {
  const bool is_smaller = extent_ != scheduler::Extent{cut_.columns.size(), cut_.rows.size()};
  Photograph result = std::visit(
      [&]<typename T>(const Image<T>& image) {
        const ImageView<const T> pixels = cut(image.view(), cut_);
        return is_smaller ? area_average(pixels, extent_.columns, extent_.rows, execution)
                          : Photograph{Image<T>::borrowed(pixels), photograph.origin};
      },
      photograph.pixels);
  if (photograph.left_out.empty()) {
    return result;
  }
  const ImageView<const std::uint8_t> left_out = cut(photograph.left_out.view(), cut_);
  if (is_smaller) {
    // 255 where nothing of the area shows the scene: the mean is rounded to it within half a level.
    result.left_out = std::move(
        std::get<Mask>(area_average(left_out, extent_.columns, extent_.rows, execution).pixels));
    execution.for_each_row(extent_.rows, [&](int y) {
      for (int x = 0; x < extent_.columns; ++x) {
        std::uint8_t& share = result.left_out.at(x, y);
        share = share == 255 ? 255 : 0;
      }
    });
  } else {
    result.left_out = Mask::borrowed(left_out);
  }
  return result;
}

DisparityMap MatchedPart::of_prior(ImageView<const float> map_px) const {
  DisparityMap result;
  if (map_px.empty()) {
    return result;
  }
  const ImageView<const float> pixels = cut(map_px, cut_);
  result.resize(extent_.columns, extent_.rows);
  const float ratio = static_cast<float>(extent_.columns) / static_cast<float>(pixels.width());
  for (int y = 0; y < extent_.rows; ++y) {
    for (int x = 0; x < extent_.columns; ++x) {
      const auto at = [](int i, int count, int of) {
        return static_cast<int>((static_cast<long long>(2) * i + 1) * of / (2LL * count));
      };
      result.at(x, y) = ratio * pixels.at(at(x, extent_.columns, pixels.width()),
                                          at(y, extent_.rows, pixels.height()));
    }
  }
  return result;
}

void MatchedPart::bring_back(const MatchedMap& map_of_part, const Photograph& matched,
                             std::size_t index, const Photograph& image, Execution& execution,
                             MatchedMap& map) const {
  const auto start = [&]<typename T>(const Image<T>& of_part, T unknown, Image<T>& whole) {
    if (of_part.empty()) {
      whole.resize(0, 0);
      return;
    }
    whole.resize(images_.columns, images_.rows);
    whole.fill(unknown);
  };
  start(map_of_part.disparity_px, kNaN, map.disparity_px);
  start(map_of_part.disparity_y_px, kNaN, map.disparity_y_px);
  start(map_of_part.confidence, kNaN, map.confidence);
  start(map_of_part.unmatched, kUnmatched, map.unmatched);
  enlarge(map_of_part, matched, image, wanted_[index], execution, map);
  erase_left_out(image.left_out, execution, map);
}

void MatchedPart::enlarge(const MatchedMap& map_of_part, const Photograph& matched,
                          const Photograph& image, const Region& wanted, Execution& execution,
                          MatchedMap& map) const {
  const std::vector<Neighbours> columns = neighbours_of(cut_.columns.size(), extent_.columns);
  const std::vector<Neighbours> rows = neighbours_of(cut_.rows.size(), extent_.rows);
  const float px_per_column =
      static_cast<float>(cut_.columns.size()) / static_cast<float>(extent_.columns);
  const float px_per_row = static_cast<float>(cut_.rows.size()) / static_cast<float>(extent_.rows);
  execution.for_each_band(wanted.rows.size(), [&](int first_row, int end_row) {
    std::vector<float> grey(static_cast<std::size_t>(images_.columns));
    std::array<std::vector<float>, 2> grey_of_part;
    grey_of_part.fill(std::vector<float>(static_cast<std::size_t>(extent_.columns)));
    for (int y = wanted.rows.begin + first_row; y < wanted.rows.begin + end_row; ++y) {
      const Neighbours& row = rows[static_cast<std::size_t>(y - cut_.rows.begin)];
      intensity_row(image, y, grey.data());
      intensity_row(matched, row.near, grey_of_part[0].data());
      intensity_row(matched, row.beside, grey_of_part[1].data());
      for (int x = wanted.columns.begin; x < wanted.columns.end; ++x) {
        const Neighbours& column = columns[static_cast<std::size_t>(x - cut_.columns.begin)];
        const float own = grey[static_cast<std::size_t>(x)];
        const auto value = [&](const DisparityMap& of_part, float px, DisparityRange range) {
          const float near = of_part.at(column.near, row.near);
          const std::array<float, 3> others = {of_part.at(column.beside, row.near),
                                               of_part.at(column.near, row.beside),
                                               of_part.at(column.beside, row.beside)};
          const bool is_surface = std::ranges::all_of(others, [&](float other) {
            return std::abs(other - near) <= kernels::kEnlargedSurfaceStepPx;
          });
          float best = near;
          if (is_surface) {
            const float w = column.weight_beside;
            const float above = near + w * (others[0] - near);
            const float below = others[1] + w * (others[2] - others[1]);
            best = above + row.weight_beside * (below - above);
          } else if (std::isfinite(near)) {
            const auto contrast = [&](int part_column, std::size_t part_row) {
              return std::abs(grey_of_part[part_row][static_cast<std::size_t>(part_column)] - own);
            };
            const std::array<float, 3> contrasts = {
                contrast(column.beside, 0), contrast(column.near, 1), contrast(column.beside, 1)};
            float least =
                contrast(column.near, 0) - static_cast<float>(kernels::kEnlargedPreference);
            for (std::size_t i = 0; i < others.size(); ++i) {
              if (std::isfinite(others[i]) && contrasts[i] < least) {
                least = contrasts[i];
                best = others[i];
              }
            }
          }
          // NaN stays as it is.
          return std::clamp(px * best, static_cast<float>(range.min),
                            static_cast<float>(range.max));
        };
        map.disparity_px.at(x, y) = value(map_of_part.disparity_px, px_per_column, range_);
        if (!map.disparity_y_px.empty()) {
          map.disparity_y_px.at(x, y) = value(map_of_part.disparity_y_px, px_per_row, *range_y_);
        }
        if (!map.confidence.empty()) {
          map.confidence.at(x, y) = map_of_part.confidence.at(column.near, row.near);
        }
        if (!map.unmatched.empty()) {
          map.unmatched.at(x, y) = map_of_part.unmatched.at(column.near, row.near);
        }
      }
    }
  });
}

}  // namespace vantage
