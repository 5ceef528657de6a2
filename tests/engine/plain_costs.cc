#include "tests/engine/plain_costs.h"

#include "tests/engine/engine_test.h"
#include "tests/engine/plain_cost_cells.h"

namespace vantage {
inline namespace test {
namespace {

using Taps = std::vector<double>;

Plane correlate(const Plane& plane, const Taps& along_x, const Taps& along_y) {
  const int radius_x = static_cast<int>(along_x.size()) / 2;
  const int radius_y = static_cast<int>(along_y.size()) / 2;
  Plane result{plane.width, plane.height, {}};
  for (const auto [x, y] : positions_of(plane.width, plane.height)) {
    double sum = 0;
    for (int v = -radius_y; v <= radius_y; ++v) {
      for (int u = -radius_x; u <= radius_x; ++u) {
        sum += along_x[static_cast<std::size_t>(u + radius_x)] *
               along_y[static_cast<std::size_t>(v + radius_y)] * plane.at(x + u, y + v);
      }
    }
    result.values.push_back(sum);
  }
  return result;
}

/// σ = ½, radius 2.
Taps prefilter_taps() {
  Taps taps;
  double sum = 0;
  for (int k = -2; k <= 2; ++k) {
    taps.push_back(std::exp(-k * k / (2 * 0.5 * 0.5)));
    sum += taps.back();
  }
  for (double& tap : taps) {
    tap /= sum;
  }
  return taps;
}

/// Cells of two images as stage_cost.h states them.
Volume cells_of_pair(const Photograph& reference, const Photograph& other, Side reference_is,
                     DisparityRange range, const MethodParameters& parameters,
                     CellMeaning meaning) {
  const int steps = static_cast<int>(std::lround(1 / parameters.candidate_step_px));
  Volume cells(reference.width(), reference.height(), range, reference_is, 0, steps);
  const kernels::CandidateGeometry geometry{cells.width, steps * range.min, cells.count(),
                                            cells.direction, steps};
  const PlainCostCells plain(parameters, geometry, reference, {{.photograph = &other}}, meaning);
  cells.cells.clear();
  for (const auto [x, y] : positions_of(cells.width, cells.height)) {
    const std::vector<double> column = plain.column(x, y);
    cells.cells.insert(cells.cells.end(), column.begin(), column.end());
  }
  return cells;
}

}  // namespace

Volume::Volume(int width_px, int height_px, DisparityRange disparities, Side reference,
               double value, int steps_per_px)
    : width(width_px),
      height(height_px),
      range(disparities),
      direction(direction_of(reference)),
      steps(steps_per_px) {
  cells.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) *
                   static_cast<std::size_t>(count()),
               value);
}

Volume Volume::like(const Volume& other) {
  return {other.width, other.height, other.range, other.direction < 0 ? Side::kLeft : Side::kRight,
          0,           other.steps};
}

Plane resampled(const Plane& plane, double fraction) {
  if (fraction == 0) {
    return plane;
  }
  const auto weight = [](double distance) {
    const double t = std::abs(distance);
    return t < 1 ? 1.5 * t * t * t - 2.5 * t * t + 1 : -.5 * t * t * t + 2.5 * t * t - 4 * t + 2;
  };
  Plane result{plane.width, plane.height, {}};
  for (const auto [x, y] : positions_of(plane.width, plane.height)) {
    double sum = 0;
    double min = std::numeric_limits<double>::infinity();
    double max = -min;
    for (int u = -1; u <= 2; ++u) {
      const double value = plane.at(x + u, y);
      sum += weight(u - fraction) * value;
      min = std::min(min, value);
      max = std::max(max, value);
    }
    result.values.push_back(std::clamp(sum, min, max));
  }
  return result;
}

double Plane::at(int x, int y) const {
  const int column = std::clamp(x, 0, width - 1);
  const int row = std::clamp(y, 0, height - 1);
  return values[static_cast<std::size_t>(row) * static_cast<std::size_t>(width) +
                static_cast<std::size_t>(column)];
}

std::vector<Plane> planes_of(const Photograph& photograph, ColourUse colour) {
  const bool is_colour = photograph.channels() >= 3;
  const int count = is_colour && colour == ColourUse::kChannels ? 3 : 1;
  std::vector<Plane> planes(static_cast<std::size_t>(count),
                            Plane{photograph.width(), photograph.height(), {}});
  std::visit(
      [&](const auto& image) {
        using T = std::remove_cvref_t<decltype(image.at(0, 0))>;
        const double unit = std::is_same_v<T, std::uint8_t>    ? 1.0
                            : std::is_same_v<T, std::uint16_t> ? 255.0 / 65535.0
                                                               : 255.0;
        for (const auto [x, y] : positions_of(image)) {
          if (count == 3) {
            for (int c = 0; c < 3; ++c) {
              planes[static_cast<std::size_t>(c)].values.push_back(unit * image.at(x, y, c));
            }
          } else if (is_colour) {
            planes[0].values.push_back(unit *
                                       (0.299 * image.at(x, y, 0) + 0.587 * image.at(x, y, 1) +
                                        0.114 * image.at(x, y, 2)));
          } else {
            planes[0].values.push_back(unit * image.at(x, y));
          }
        }
      },
      photograph.pixels);
  return planes;
}

Gradient gradient_of(const Plane& plane, GradientFilter filter, bool prefilter) {
  const Plane smooth = prefilter ? correlate(plane, prefilter_taps(), prefilter_taps()) : plane;
  Taps derivative;
  Taps across;
  switch (filter) {
    case GradientFilter::kCentral:
      derivative = {-1, 0, 1};
      across = {1};
      break;
    case GradientFilter::kForward:  // (5.8)
      derivative = {0, -1, 1};
      across = {1};
      break;
    case GradientFilter::kSobel:
      derivative = {-1, 0, 1};
      across = {1, 2, 1};
      break;
    case GradientFilter::kSimoncelli3:
      derivative = {-.4553, 0, .4553};
      across = {.2242, .5516, .2242};
      break;
    case GradientFilter::kSimoncelli5:
      derivative = {-.1077, -.2827, 0, .2827, .1077};
      across = {.0357, .2489, .4308, .2489, .0357};
      break;
  }
  return {correlate(smooth, derivative, across), correlate(smooth, across, derivative)};
}

double length_of(double x, double y, const MethodParameters& parameters) {
  if (parameters.gradient_components == GradientComponents::kX) {
    return std::abs(x);
  }
  const double l1 = std::abs(x) + std::abs(y);
  const double max = std::max(std::abs(x), std::abs(y));
  switch (parameters.norm) {
    case GradientNorm::kL2:
      break;
    case GradientNorm::kOctagon:
      return .3978247 * l1 + .5626091 * max;
    case GradientNorm::kL1:
      return l1;
    case GradientNorm::kMax:
      return max;
  }
  return std::sqrt(x * x + y * y);
}

Volume plain_costs(const Photograph& reference, const Photograph& other, Side reference_is,
                   DisparityRange range, const MethodParameters& parameters) {
  return cells_of_pair(reference, other, reference_is, range, parameters, CellMeaning::kEnergy);
}

Volume plain_measurement_energies(const Photograph& reference, const Photograph& other,
                                  Side reference_is, DisparityRange range,
                                  const MethodParameters& parameters) {
  Volume energies =
      cells_of_pair(reference, other, reference_is, range, parameters, CellMeaning::kLikelihood);
  for (double& cell : energies.cells) {
    cell = -std::log(cell);
  }
  return energies;
}

Volume plain_grey(const Photograph& photograph) {
  Volume grey(photograph.width(), photograph.height(), {0, 0}, Side::kLeft);
  grey.cells = planes_of(photograph, ColourUse::kLuma).front().values;
  return grey;
}

}  // namespace test
}  // namespace vantage
