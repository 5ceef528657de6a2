#include "engine/reprojection/point_cloud.h"

#include <fmt/format.h>

#include <cmath>
#include <string_view>

#include "engine/error.h"
#include "engine/image/eight_bit.h"

namespace vantage {
namespace {

constexpr std::uint8_t kMiddleGrey = 128;

void require_size(std::string_view name, int width, int height,
                  ImageView<const float> disparity_px) {
  if (width != disparity_px.width() || height != disparity_px.height()) {
    throw Error(fmt::format("the {} is {}x{} but the disparity map is {}x{}, expected equal sizes",
                            name, width, height, disparity_px.width(), disparity_px.height()));
  }
}

void check(const CloudSource& source, const CloudOptions& options) {
  options.validate();
  if (source.disparity_px.empty()) {
    throw Error("a cloud needs a disparity map, expected at least one pixel");
  }
  if (source.colours != nullptr) {
    require_size("image", source.colours->width(), source.colours->height(), source.disparity_px);
  }
  if (!source.unmatched.empty()) {
    require_size("mask of filled pixels", source.unmatched.width(), source.unmatched.height(),
                 source.disparity_px);
  }
  if (options.reads_confidence()) {
    require_size("confidence", source.confidence.width(), source.confidence.height(),
                 source.disparity_px);
  }
}

bool jumps(float a, float b, float limit_px) { return std::abs(a - b) > limit_px; }  // not with NaN

/// Points of all pixels of a map, and which of them are kept.
class PixelPoints {
 public:
  PixelPoints(const CloudSource& source, const CloudOptions& options, Execution& execution)
      : source_(source), options_(options) {
    if (source.colours != nullptr) {
      colours_ = eight_bit(*source.colours);
    }
    reproject(source.disparity_px, source.camera, options.max_depth.value_or(kNoMaxDepth),
              execution, points_);
    if (!options.keeps_outlines) {
      outline_mask(source.disparity_px, options.gradient_limit_px, execution, outlines_);
    }
  }

  [[nodiscard]] bool is_kept(int x, int y) const {
    return !std::isnan(points_.at(x, y)) && (outlines_.empty() || outlines_.at(x, y) == 0) &&
           (options_.keeps_filled || source_.unmatched.empty() ||
            source_.unmatched.at(x, y) == 0) &&
           (!options_.min_confidence ||
            static_cast<double>(source_.confidence.at(x, y)) >= *options_.min_confidence);
  }

  void add(int x, int y, PointCloud& cloud) const {
    const float* point = points_.row(y) + 3 * x;
    cloud.positions.insert(cloud.positions.end(), point, point + 3);
    const bool is_grey = colours_.channels() == 1;
    for (int channel = 0; channel < 3; ++channel) {
      cloud.colours.push_back(colours_.empty() ? kMiddleGrey
                                               : colours_.at(x, y, is_grey ? 0 : channel));
    }
    if (options_.with_confidence) {
      cloud.confidence.push_back(source_.confidence.at(x, y));
    }
  }

 private:
  const CloudSource& source_;
  const CloudOptions& options_;
  Image<std::uint8_t> colours_;  // empty: all points are grey
  Image<float> points_;
  Mask outlines_;
};

/// Whether pixels of the square from (x, y) to (x + step, y + step) are of one surface. Unknown
/// ones are not, but at its corners, where a triangle may be without one.
bool is_one_surface(ImageView<const float> disparity_px, int x, int y, int step, float limit_px) {
  for (int row = y; row <= y + step; ++row) {
    for (int column = x; column <= x + step; ++column) {
      const float here = disparity_px.at(column, row);
      const bool is_corner = (column == x || column == x + step) && (row == y || row == y + step);
      if (!std::isfinite(here)) {
        if (!is_corner) {
          return false;
        }
        continue;
      }
      if ((column < x + step && jumps(here, disparity_px.at(column + 1, row), limit_px)) ||
          (row < y + step && jumps(here, disparity_px.at(column, row + 1), limit_px))) {
        return false;
      }
    }
  }
  return true;
}

[[noreturn]] void fail_empty(std::string_view what) {
  throw Error(
      fmt::format("the {} is empty: no pixel has a disparity that was measured, and not just "
                  "filled, within the limits of depth and confidence; expected at least one",
                  what));
}

}  // namespace

void CloudOptions::validate() const {
  if (max_depth && !(*max_depth > 0)) {
    throw UsageError(fmt::format("max-depth is {}, expected a number above 0", *max_depth));
  }
  if (step_px < 1 || step_px > kMaxCloudStep_px) {
    throw UsageError(
        fmt::format("cloud-step is {}, expected a number from 1 to {}", step_px, kMaxCloudStep_px));
  }
  if (min_confidence && !std::isfinite(*min_confidence)) {
    throw UsageError("cloud-min-confidence is not finite, expected a number");
  }
  if (!(gradient_limit_px > 0)) {
    throw UsageError(
        fmt::format("cloud-gradient-limit is {}, expected a number above 0", gradient_limit_px));
  }
}

void outline_mask(ImageView<const float> disparity_px, double gradient_limit_px,
                  Execution& execution, Mask& outlines) {
  const int width = disparity_px.width();
  const int height = disparity_px.height();
  const auto limit_px = static_cast<float>(gradient_limit_px);
  outlines.resize(width, height);
  execution.for_each_row(height, [&](int y) {
    for (int x = 0; x < width; ++x) {
      const float here = disparity_px.at(x, y);
      const bool ends = (x > 0 && jumps(here, disparity_px.at(x - 1, y), limit_px)) ||
                        (x + 1 < width && jumps(here, disparity_px.at(x + 1, y), limit_px)) ||
                        (y > 0 && jumps(here, disparity_px.at(x, y - 1), limit_px)) ||
                        (y + 1 < height && jumps(here, disparity_px.at(x, y + 1), limit_px));
      outlines.at(x, y) = ends ? 255 : 0;
    }
  });
}

PointCloud point_cloud(const CloudSource& source, const CloudOptions& options,
                       Execution& execution) {
  check(source, options);
  const PixelPoints pixels(source, options, execution);
  PointCloud cloud;
  for (int y = 0; y < source.disparity_px.height(); y += options.step_px) {
    for (int x = 0; x < source.disparity_px.width(); x += options.step_px) {
      if (pixels.is_kept(x, y)) {
        pixels.add(x, y, cloud);
      }
    }
  }
  if (cloud.size() == 0 && !options.may_be_empty) {
    fail_empty("cloud");
  }
  return cloud;
}

TriangleMesh triangle_mesh(const CloudSource& source, const CloudOptions& options,
                           Execution& execution) {
  check(source, options);
  const PixelPoints pixels(source, options, execution);
  const int step = options.step_px;
  const int columns = (source.disparity_px.width() - 1) / step + 1;
  const int rows = (source.disparity_px.height() - 1) / step + 1;
  const auto limit_px = static_cast<float>(options.gradient_limit_px);
  TriangleMesh mesh;
  // Vertices get their numbers when a triangle first needs them.
  constexpr std::int32_t kNone = -1;
  std::vector<std::int32_t> numbers(
      static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), kNone);
  const auto add_corner = [&](int column, int row) {
    std::int32_t& number =
        numbers[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                static_cast<std::size_t>(column)];
    if (number == kNone) {
      number = static_cast<std::int32_t>(mesh.vertices.size());
      pixels.add(column * step, row * step, mesh.vertices);
    }
    mesh.triangles.push_back(number);
  };
  for (int row = 0; row + 1 < rows; ++row) {
    for (int column = 0; column + 1 < columns; ++column) {
      // Around the square, counter-clockwise as the camera sees it.
      constexpr int kAround[4][2] = {{0, 0}, {0, 1}, {1, 1}, {1, 0}};
      bool kept[4];
      int count = 0;
      for (int k = 0; k < 4; ++k) {
        kept[k] = pixels.is_kept((column + kAround[k][0]) * step, (row + kAround[k][1]) * step);
        count += kept[k] ? 1 : 0;
      }
      if (count < 3 ||
          !is_one_surface(source.disparity_px, column * step, row * step, step, limit_px)) {
        continue;
      }
      const auto add_triangle = [&](int a, int b, int c) {
        for (const int k : {a, b, c}) {
          add_corner(column + kAround[k][0], row + kAround[k][1]);
        }
      };
      if (count == 4) {
        add_triangle(0, 1, 3);
        add_triangle(1, 2, 3);
        continue;
      }
      const int missing = !kept[0] ? 0 : !kept[1] ? 1 : !kept[2] ? 2 : 3;
      add_triangle((missing + 1) % 4, (missing + 2) % 4, (missing + 3) % 4);
    }
  }
  if (mesh.triangles.empty() && !options.may_be_empty) {
    fail_empty("mesh");
  }
  return mesh;
}

}  // namespace vantage
