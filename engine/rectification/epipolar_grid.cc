#include "engine/rectification/epipolar_grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <variant>

#include "engine/error.h"
#include "engine/image/remapped_row.h"
#include "engine/rectification/rectifier.h"

namespace vantage {
namespace {

/// Lenses are smooth: over so few pixels, positions are linear to some thousandths of a pixel.
constexpr int kKnotPx = 4;
/// Pixels farther outside are not used: the rectified image of a wide lens has no limit.
constexpr int kMaxOutside = 1;  // image sizes

struct Bounds {
  double min = std::numeric_limits<double>::infinity();
  double max = -std::numeric_limits<double>::infinity();

  void add(double value) {
    min = std::min(min, value);
    max = std::max(max, value);
  }
};

struct Outline {
  Bounds x;
  Bounds y;
};

/// What the rectified positions of a photograph's pixels span.
Outline outline_of(const Rectifier& rectifier, Side side) {
  const int width = rectifier.pair().width_px;
  const int height = rectifier.pair().height_px;
  Outline outline;
  RectifiedPositions positions(rectifier, side);
  for (int y = 0; y < height; ++y) {
    const bool is_whole = y == 0 || y == height - 1;
    for (int x = 0; x < width; x += is_whole ? 1 : std::max(1, width - 1)) {
      const Eigen::Vector2d at = positions.position(x, y);
      if (!at.hasNaN()) {
        outline.x.add(std::clamp<double>(at.x(), -kMaxOutside * width, (1 + kMaxOutside) * width));
        outline.y.add(
            std::clamp<double>(at.y(), -kMaxOutside * height, (1 + kMaxOutside) * height));
      }
    }
  }
  return outline;
}

}  // namespace

EpipolarGrid::EpipolarGrid(const Rectifier& rectifier, Side reference, Execution& execution)
    : reference_(reference),
      reference_width_(rectifier.pair().width_px),
      reference_height_(rectifier.pair().height_px) {
  find_window(rectifier);
  find_positions(rectifier, execution);
  find_places(rectifier, execution);
}

/// All that the other photograph shows of the lines through the reference.
void EpipolarGrid::find_window(const Rectifier& rectifier) {
  const Outline own = outline_of(rectifier, reference_);
  const Outline other = outline_of(rectifier, other_side(reference_));
  const double top = std::max(own.y.min, other.y.min);
  const double bottom = std::min(own.y.max, other.y.max);
  if (!(bottom > top && other.x.max > other.x.min)) {
    throw Error(
        "the photographs have no epipolar line in common, expected cameras that see the "
        "same scene");
  }
  first_column_ = static_cast<int>(std::floor(other.x.min));
  first_row_ = static_cast<int>(std::floor(top));
  width_ = static_cast<int>(std::ceil(other.x.max)) - first_column_ + 1;
  height_ = static_cast<int>(std::ceil(bottom)) - first_row_ + 1;
}

void EpipolarGrid::find_positions(const Rectifier& rectifier, Execution& execution) {
  knot_columns_ = (width_ - 1) / kKnotPx + 2;
  const int knot_rows = height_ / kKnotPx + 2;
  knots_.resize(static_cast<std::size_t>(knot_columns_) * static_cast<std::size_t>(knot_rows));
  const Side other = other_side(reference_);
  execution.for_each_row(knot_rows, [&](int row) {
    for (int column = 0; column < knot_columns_; ++column) {
      knots_[static_cast<std::size_t>(row) * static_cast<std::size_t>(knot_columns_) +
             static_cast<std::size_t>(column)] =
          rectifier
              .source_position(other,
                               {first_column_ + kKnotPx * column, first_row_ + kKnotPx * row})
              .value_or(Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN()));
    }
  });
  const int lines = height_ * kPhases;
  const int samples = (width_ - 1) * kPhases + 1;
  seen_.resize(static_cast<std::size_t>(lines));
  execution.for_each_row(lines, [&](int line) {
    const auto is_seen = [&](int sample) {
      const Eigen::Vector2d at = position_of(line, sample);
      return at.x() >= -0.5 && at.x() <= reference_width_ - 0.5 && at.y() >= -0.5 &&
             at.y() <= reference_height_ - 0.5;
    };
    int begin = 0;
    while (begin < samples && !is_seen(begin)) {
      ++begin;
    }
    int last = samples - 1;
    while (last > begin && !is_seen(last)) {
      --last;
    }
    seen_[static_cast<std::size_t>(line)] =
        begin < samples ? scheduler::Range{begin, last + 1} : scheduler::Range{0, 0};
  });
}

void EpipolarGrid::find_places(const Rectifier& rectifier, Execution& execution) {
  places_.resize(static_cast<std::size_t>(reference_width_) *
                 static_cast<std::size_t>(reference_height_));
  const int lines = height_ * kPhases;
  execution.for_each_band(reference_height_, [&](int first, int end) {
    RectifiedPositions positions(rectifier, reference_);
    for (int y = first; y < end; ++y) {
      for (int x = 0; x < reference_width_; ++x) {
        Place& place =
            places_[static_cast<std::size_t>(y) * static_cast<std::size_t>(reference_width_) +
                    static_cast<std::size_t>(x)];
        const Eigen::Vector2d at = positions.position(x, y);
        if (at.hasNaN()) {
          continue;
        }
        const double line = std::floor((at.y() - first_row_) * kPhases + 0.5);
        const double along = (at.x() - first_column_) * kPhases;
        const double limit = 4.0 * (width_ + reference_width_) * kPhases;
        const double sample = std::clamp(std::floor(along + 0.5), -limit, limit);
        place.has_line = line >= 0 && line < lines;
        place.line = static_cast<std::int32_t>(std::clamp<double>(line, 0, lines - 1));
        place.sample = static_cast<std::int32_t>(sample);
      }
    }
  });
}

Eigen::Vector2d EpipolarGrid::position_of(double line, double sample) const {
  const double across = sample / (kPhases * kKnotPx);
  const double down = line / (kPhases * kKnotPx);
  const double column = std::floor(across);
  const double row = std::floor(down);
  if (!(column >= 0 && column < knot_columns_ - 1 && row >= 0 && row < height_ / kKnotPx + 1)) {
    return Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());
  }
  const Eigen::Vector2d* const knot = knots_.data() +
                                      static_cast<std::ptrdiff_t>(row) * knot_columns_ +
                                      static_cast<std::ptrdiff_t>(column);
  const double x = across - column;
  const double y = down - row;
  return (1 - y) * ((1 - x) * knot[0] + x * knot[1]) +
         y * ((1 - x) * knot[knot_columns_] + x * knot[knot_columns_ + 1]);
}

void EpipolarGrid::sample(const Photograph& other, int along, int down, Photograph& result,
                          Execution& execution) const {
  if (other.width() != reference_width_ || other.height() != reference_height_) {
    throw Error(fmt::format("the photograph is {}x{}, expected {}x{} as in its calibration",
                            other.width(), other.height(), reference_width_, reference_height_));
  }
  std::visit(
      [&]<typename T>(const Image<T>& from) {
        Image<T> to(width_, height_, from.channels());
        execution.for_each_band(height_, [&](int first, int end) {
          std::vector<float> x_px(static_cast<std::size_t>(width_));
          std::vector<float> y_px(static_cast<std::size_t>(width_));
          for (int y = first; y < end; ++y) {
            for (int x = 0; x < width_; ++x) {
              const Eigen::Vector2d at = position_of(down + y * kPhases, along + x * kPhases);
              x_px[static_cast<std::size_t>(x)] = static_cast<float>(at.x());
              y_px[static_cast<std::size_t>(x)] = static_cast<float>(at.y());
            }
            remap_row(from, x_px.data(), y_px.data(), y, to);
          }
        });
        result = {std::move(to), other.origin};
      },
      other.pixels);
}

std::shared_ptr<const EpipolarGrids> epipolar_grids(const Rectifier& rectifier,
                                                    Execution& execution) {
  return std::make_shared<const EpipolarGrids>(
      EpipolarGrids{EpipolarGrid(rectifier, Side::kLeft, execution),
                    EpipolarGrid(rectifier, Side::kRight, execution)});
}

}  // namespace vantage
