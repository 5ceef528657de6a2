#include "tests/engine/plain_costs.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <type_traits>
#include <utility>
#include <variant>

namespace vantage::test {
namespace {

using Taps = std::vector<double>;

Plane correlate(const Plane& plane, const Taps& along_x, const Taps& along_y) {
  const int radius_x = static_cast<int>(along_x.size()) / 2;
  const int radius_y = static_cast<int>(along_y.size()) / 2;
  Plane result{plane.width, plane.height, {}};
  for (int y = 0; y < plane.height; ++y) {
    for (int x = 0; x < plane.width; ++x) {
      double sum = 0;
      for (int v = -radius_y; v <= radius_y; ++v) {
        for (int u = -radius_x; u <= radius_x; ++u) {
          sum += along_x[static_cast<std::size_t>(u + radius_x)] *
                 along_y[static_cast<std::size_t>(v + radius_y)] * plane.at(x + u, y + v);
        }
      }
      result.values.push_back(sum);
    }
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

/// What one channel of both photographs offers to compare.
struct Channel {
  Plane reference;
  Plane other;
  Gradient reference_gradient;
  Gradient other_gradient;
};

/// How far `value` is from the values that `plane`, interpolated linearly, takes within half a
/// pixel of (x, y) (Birchfield and Tomasi).
double distance_to_interval(double value, const Plane& plane, int x, int y) {
  const double here = plane.at(x, y);
  const double before = (plane.at(x - 1, y) + here) / 2;
  const double after = (plane.at(x + 1, y) + here) / 2;
  const double min = std::min({before, here, after});
  const double max = std::max({before, here, after});
  return std::max({0.0, value - max, min - value});
}

/// Which of the neighbours in a window reaching this far are darker than its centre.
struct CensusWindow {
  int columns;
  int rows;
};
std::vector<bool> census_code(const Plane& plane, int x, int y, CensusWindow window) {
  std::vector<bool> code;
  for (int v = -window.rows; v <= window.rows; ++v) {
    for (int u = -window.columns; u <= window.columns; ++u) {
      if (u != 0 || v != 0) {
        code.push_back(plane.at(x + u, y + v) < plane.at(x, y));
      }
    }
  }
  return code;
}

/// Which neighbours on rays, up to 4 px along rows and columns and 2 px along diagonals, are less
/// than the centre + `margin`.
std::vector<bool> ray_code(const Plane& plane, int x, int y, double margin) {
  std::vector<bool> code;
  for (int length = 1; length <= 4; ++length) {
    for (int v = -1; v <= 1; ++v) {
      for (int u = -1; u <= 1; ++u) {
        const bool is_diagonal = u != 0 && v != 0;
        if ((u != 0 || v != 0) && (!is_diagonal || length <= 2)) {
          code.push_back(plane.at(x + length * u, y + length * v) < plane.at(x, y) + margin);
        }
      }
    }
  }
  return code;
}

/// Neighbours of 24 that differ, on the average of the thresholds.
double ray_census_distance(const Channel& channel, int x, int partner, int y, int thresholds) {
  double different = 0;
  for (const double margin : {0.0, -1.2505, 1.2505}) {
    const std::vector<bool> a = ray_code(channel.reference, x, y, margin);
    const std::vector<bool> b = ray_code(channel.other, partner, y, margin);
    for (std::size_t i = 0; i < a.size(); ++i) {
      different += a[i] != b[i] ? 1 : 0;
    }
    if (thresholds == 1) {
      return different;
    }
  }
  return different / 3;
}

double census_distance(const Channel& channel, int x, int partner, int y, CensusWindow window) {
  const std::vector<bool> a = census_code(channel.reference, x, y, window);
  const std::vector<bool> b = census_code(channel.other, partner, y, window);
  int different = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    different += a[i] != b[i] ? 1 : 0;
  }
  return different;
}

/// (5.5).
double evidence(const Channel& channel, int x, int partner, int y,
                const MethodParameters& parameters) {
  const double ax = channel.reference_gradient.x.at(x, y);
  const double ay = channel.reference_gradient.y.at(x, y);
  const double bx = channel.other_gradient.x.at(partner, y);
  const double by = channel.other_gradient.y.at(partner, y);
  return (length_of(ax, ay, parameters) + length_of(bx, by, parameters)) / 2 -
         parameters.alpha * length_of(ax - bx, ay - by, parameters);
}

/// (6.21).
double contaminated(double squared_difference, const MethodParameters& parameters) {
  const double epsilon = parameters.epsilon_measurement;
  const double sigma = parameters.sigma_measurement;
  return -std::log((1 - epsilon) * std::exp(-squared_difference / (2 * sigma * sigma)) + epsilon);
}

double sampling_insensitive(const Channel& channel, int x, int partner, int y) {
  return std::min(distance_to_interval(channel.reference.at(x, y), channel.other, partner, y),
                  distance_to_interval(channel.other.at(partner, y), channel.reference, x, y));
}

double cost_of_channel(const Channel& channel, int x, int partner, int y,
                       const MethodParameters& parameters) {
  const double difference = channel.reference.at(x, y) - channel.other.at(partner, y);
  switch (parameters.cost) {
    case MatchCost::kSquared:
      return difference * difference;
    case MatchCost::kAbsolute:
      return std::abs(difference);
    case MatchCost::kTruncated:
      return std::min(std::abs(difference), parameters.truncation);
    case MatchCost::kBirchfieldTomasi:
      return sampling_insensitive(channel, x, partner, y);
    case MatchCost::kGradient:
      return -evidence(channel, x, partner, y, parameters);
    case MatchCost::kContaminated:
      return contaminated(difference * difference, parameters);
    case MatchCost::kCensus:
      return census_distance(channel, x, partner, y, {.columns = 4, .rows = 3});
    case MatchCost::kRayCensus:
      return ray_census_distance(channel, x, partner, y, parameters.census_thresholds);
  }
  return std::numeric_limits<double>::quiet_NaN();
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
  for (int y = 0; y < plane.height; ++y) {
    for (int x = 0; x < plane.width; ++x) {
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
        for (int y = 0; y < image.height(); ++y) {
          for (int x = 0; x < image.width(); ++x) {
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
  const std::vector<Plane> reference_planes = planes_of(reference, parameters.colour);
  const std::vector<Plane> other_planes = planes_of(other, parameters.colour);
  const int steps = static_cast<int>(std::lround(1 / parameters.candidate_step_px));
  // The other image at every fraction of a pixel.
  std::vector<std::vector<Channel>> phases;
  for (int phase = 0; phase < steps; ++phase) {
    const double fraction = static_cast<double>(phase) / steps;
    std::vector<Channel> channels;
    for (std::size_t c = 0; c < reference_planes.size(); ++c) {
      channels.push_back({reference_planes[c], resampled(other_planes[c], fraction), {}, {}});
      if (parameters.cost == MatchCost::kGradient) {
        channels.back().reference_gradient =
            gradient_of(reference_planes[c], parameters.gradient, parameters.prefilter);
        channels.back().other_gradient =
            gradient_of(channels.back().other, parameters.gradient, parameters.prefilter);
      }
    }
    phases.push_back(channels);
  }
  Volume costs(reference.width(), reference.height(), range, reference_is, 0, steps);
  for_each_cell(costs, [&](int x, int y, int i) {
    double& cell = costs.at(x, y, i);
    if (!costs.has_partner(x, i)) {
      if (parameters.cost == MatchCost::kGradient) {
        return;  // 0
      }
      if (parameters.cost == MatchCost::kContaminated) {
        cell = -std::log(parameters.epsilon_measurement);
        return;
      }
    }
    const double position = std::clamp(costs.partner(x, i), 0., costs.width - 1.);
    const int partner = static_cast<int>(std::floor(position));
    const auto phase = static_cast<std::size_t>(std::lround((position - partner) * steps));
    for (const Channel& channel : phases[phase]) {
      cell += cost_of_channel(channel, x, partner, y, parameters);
    }
    cell /= static_cast<double>(phases[phase].size());
  });
  return costs;
}

Volume plain_measurement_energies(const Photograph& reference, const Photograph& other,
                                  Side reference_is, DisparityRange range,
                                  const MethodParameters& parameters) {
  Volume energies = plain_costs(reference, other, reference_is, range, parameters);
  const double epsilon = parameters.epsilon_measurement;
  for (int y = 0; y < energies.height; ++y) {
    for (int x = 0; x < energies.width; ++x) {
      double max_evidence = -std::numeric_limits<double>::infinity();
      for (int i = 0; i < energies.count(); ++i) {
        if (energies.has_partner(x, i)) {
          max_evidence = std::max(max_evidence, -energies.at(x, y, i));
        }
      }
      for (int i = 0; i < energies.count(); ++i) {
        double& cell = energies.at(x, y, i);
        if (!energies.has_partner(x, i)) {
          cell = -std::log(epsilon);
        } else if (parameters.cost == MatchCost::kGradient) {
          const double exponent = (-cell - max_evidence) / parameters.sigma_measurement;
          cell = -std::log((1 - epsilon) * std::exp(exponent) + epsilon);
        } else if (parameters.cost == MatchCost::kSquared) {
          cell = contaminated(cell, parameters);
        } else if (parameters.cost != MatchCost::kContaminated) {
          cell = contaminated(cell * cell, parameters);
        }
      }
    }
  }
  return energies;
}

Volume plain_grey(const Photograph& photograph) {
  Volume grey(photograph.width(), photograph.height(), {0, 0}, Side::kLeft);
  grey.cells = planes_of(photograph, ColourUse::kLuma).front().values;
  return grey;
}

}  // namespace vantage::test
