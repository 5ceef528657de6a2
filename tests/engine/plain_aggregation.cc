#include "tests/engine/plain_aggregation.h"
#include "tests/engine/engine_test.h"

namespace vantage {
inline namespace test {
namespace {

constexpr std::array<std::pair<int, int>, 4> kNeighbours = {{{-1, 0}, {1, 0}, {0, -1}, {0, 1}}};

bool is_inside(const Volume& volume, int x, int y) {
  return x >= 0 && x < volume.width && y >= 0 && y < volume.height;
}

std::vector<double> column_of(const Volume& volume, int x, int y) {
  std::vector<double> column;
  for (int i = 0; i < volume.count(); ++i) {
    column.push_back(volume.at(x, y, i));
  }
  return column;
}

double log_of_sum_of_exponentials(const std::vector<double>& exponents) {
  const double max = *std::max_element(exponents.begin(), exponents.end());
  double sum = 0;
  for (const double exponent : exponents) {
    sum += std::exp(exponent - max);
  }
  return max + std::log(sum);
}

/// (6.25), (6.36): p ∝ exp(−E) down each column.
Volume probabilities_of(const Volume& energies) {
  Volume result = Volume::like(energies);
  for (const auto [x, y] : positions_of(energies.width, energies.height)) {
    std::vector<double> exponents = column_of(energies, x, y);
    for (double& exponent : exponents) {
      exponent = -exponent;
    }
    const double log_sum = log_of_sum_of_exponentials(exponents);
    for (int i = 0; i < energies.count(); ++i) {
      result.at(x, y, i) = std::exp(exponents[static_cast<std::size_t>(i)] - log_sum);
    }
  }
  return result;
}

/// (6.33), (6.34): −log of pS, up to a number that all candidates of a column share.
Volume smooth_energies(const Volume& energies, const MethodParameters& parameters) {
  const int count = energies.count();
  std::vector<double> penalties;  // of offsets −(count − 1) … count − 1
  for (int k = 1 - count; k < count; ++k) {
    const double offset_px = static_cast<double>(k) / energies.steps;
    penalties.push_back(plain_penalty(parameters, offset_px * offset_px));
  }
  Volume result = Volume::like(energies);
  for (const auto [x, y] : positions_of(energies.width, energies.height)) {
    const std::vector<double> column = column_of(energies, x, y);
    for (int i = 0; i < count; ++i) {
      const auto first = penalties.begin() + (count - 1 - i);
      result.at(x, y, i) =
          plain_support({first, first + count}, column, parameters.prior_smoothing);
    }
  }
  return result;
}

/// What a column's candidates share cancels in (6.36).
void subtract_minima(Volume& energies) {
  for (const auto [x, y] : positions_of(energies.width, energies.height)) {
    const std::vector<double> column = column_of(energies, x, y);
    const double min = *std::min_element(column.begin(), column.end());
    for (int i = 0; i < energies.count(); ++i) {
      energies.at(x, y, i) -= min;
    }
  }
}

}  // namespace

PlainEdges::PlainEdges(const Volume& grey, const MethodParameters& parameters)
    : grey_({grey}), min_(parameters.edge_weight), contrast_(parameters.edge_contrast) {
  for (int n = 0; n < std::min(parameters.edge_diffusion, parameters.iterations); ++n) {
    const Volume& before = grey_.back();
    Volume after = before;
    for_each_cell(before, [&](int x, int y, int /*cell*/) {
      double change = 0;
      for (const auto& [dx, dy] : kNeighbours) {
        if (is_inside(before, x + dx, y + dy)) {
          const double difference = before.at(x + dx, y + dy, 0) - before.at(x, y, 0);
          change += difference * std::exp(-std::abs(difference) / contrast_);
        }
      }
      after.at(x, y, 0) += 0.2 * change;
    });
    grey_.push_back(std::move(after));
  }
  if (grey_.size() > 1) {
    grey_.erase(grey_.begin());  // iteration 1 sees the image after one step
  }
}

double PlainEdges::weight(int n, int x, int y, int u, int v) const {
  if (grey_.empty()) {
    return 1;
  }
  const Volume& grey = grey_[std::min(static_cast<std::size_t>(n), grey_.size()) - 1];
  const double difference = std::abs(grey.at(x, y, 0) - grey.at(u, v, 0));
  return min_ + (1 - min_) * std::exp(-difference / contrast_);
}

Volume plain_box_mean(const Volume& costs, int window_px, Border border) {
  const int radius = window_px / 2;
  Volume result = Volume::like(costs);
  for_each_cell(costs, [&](int x, int y, int i) {
    double sum = 0;
    int samples = 0;
    for (int v = y - radius; v <= y + radius; ++v) {
      for (int u = x - radius; u <= x + radius; ++u) {
        if (is_inside(costs, u, v) && costs.has_partner(u, i)) {
          sum += costs.at(u, v, i);
          ++samples;
        }
      }
    }
    const bool is_candidate =
        costs.has_partner(x, i) &&
        (border == Border::kClip || samples == (2 * radius + 1) * (2 * radius + 1));
    result.at(x, y, i) = is_candidate ? sum / samples : std::numeric_limits<double>::quiet_NaN();
  });
  return result;
}

Volume plain_convolution(const Volume& costs, const std::vector<double>& taps) {
  const int radius = static_cast<int>(taps.size()) / 2;
  const auto pass = [&](const Volume& input, int step_x, int step_y) {
    Volume result = Volume::like(input);
    for_each_cell(input, [&](int x, int y, int i) {
      for (int k = -radius; k <= radius; ++k) {
        if (is_inside(input, x + k * step_x, y + k * step_y)) {
          result.at(x, y, i) += taps[static_cast<std::size_t>(k + radius)] *
                                input.at(x + k * step_x, y + k * step_y, i);
        }
      }
    });
    return result;
  };
  return pass(pass(costs, 1, 0), 0, 1);
}

std::vector<double> gaussian_taps(double sigma_px) {
  const int radius = static_cast<int>(std::ceil(4 * sigma_px));
  std::vector<double> taps;
  double sum = 0;
  for (int k = -radius; k <= radius; ++k) {
    taps.push_back(std::exp(-k * k / (2 * sigma_px * sigma_px)));
    sum += taps.back();
  }
  for (double& tap : taps) {
    tap /= sum;
  }
  return taps;
}

std::vector<double> box_cascade_taps(double sigma_px) {
  // In units of 1/12 px², so that equal distances compare as equal.
  const double wanted = 12 * sigma_px * sigma_px;
  std::array<int, 4> best = {1, 1, 1, 1};
  double best_distance = std::numeric_limits<double>::infinity();
  double best_flatness = 0;
  const int max = 2 * static_cast<int>(std::ceil(2 * sigma_px)) + 3;
  for (int a = 1; a <= max; a += 2) {
    for (int b = a; b <= max; b += 2) {
      for (int c = b; c <= max; c += 2) {
        for (int d = c; d <= max; d += 2) {
          const double distance = std::abs(a * a + b * b + c * c + d * d - 4 - wanted);
          double flatness = 0;
          for (const int width : {a, b, c, d}) {
            flatness += std::pow(width, 4);
          }
          if (distance < best_distance || (distance == best_distance && flatness < best_flatness)) {
            best = {a, b, c, d};
            best_distance = distance;
            best_flatness = flatness;
          }
        }
      }
    }
  }
  std::vector<double> taps = {1};
  for (const int width : best) {
    std::vector<double> wider(taps.size() + static_cast<std::size_t>(width) - 1);
    for (std::size_t i = 0; i < taps.size(); ++i) {
      for (int k = 0; k < width; ++k) {
        wider[i + static_cast<std::size_t>(k)] += taps[i] / width;
      }
    }
    taps = std::move(wider);
  }
  return taps;
}

Volume plain_membrane(const Volume& first, double lambda, double beta, int iterations,
                      const Volume* start, const PlainEdges& edges, int done) {
  Volume energies = start != nullptr ? *start : first;
  for (int n = done + 1; n <= done + iterations; ++n) {
    Volume next = energies;
    for_each_cell(energies, [&](int x, int y, int i) {
      const double here = energies.at(x, y, i);
      double change = beta * (first.at(x, y, i) - here);
      for (const auto& [dx, dy] : kNeighbours) {
        if (is_inside(energies, x + dx, y + dy)) {
          change += edges.weight(n, x, y, x + dx, y + dy) * (energies.at(x + dx, y + dy, i) - here);
        }
      }
      next.at(x, y, i) += lambda * change;
    });
    energies = std::move(next);
  }
  return energies;
}

Volume plain_diffusion(const Volume& first, double lambda, int iterations,
                       const PlainEdges& edges) {
  return plain_membrane(first, lambda, 0, iterations, nullptr, edges);
}

double plain_margin(const std::vector<double>& column) {
  std::vector<double> sorted = column;
  std::sort(sorted.begin(), sorted.end());
  double sum = 0;
  for (const double energy : sorted) {
    sum += energy;
  }
  return sorted.size() < 2 || sum == 0 ? 0 : (sorted[1] - sorted[0]) / sum;
}

double plain_negative_entropy(const std::vector<double>& column, double scale) {
  const auto best = std::min_element(column.begin(), column.end());
  double others = 0;
  double moment = 0;
  for (auto energy = column.begin(); energy != column.end(); ++energy) {
    const double odds = std::min(scale * (*energy - *best), 125 * std::log(2.0));
    others += energy == best ? 0 : std::exp(-odds);
    moment += odds * std::exp(-odds);
  }
  return -moment / (1 + others) - std::log1p(others);
}

Volume plain_local_stopping(const Volume& first, double lambda, Certainty certainty, double scale,
                            int iterations, const PlainEdges& edges) {
  const auto certainty_of = [&](const Volume& volume, int x, int y) {
    return certainty == Certainty::kMargin ? plain_margin(column_of(volume, x, y))
                                           : plain_negative_entropy(column_of(volume, x, y), scale);
  };
  Volume energies = first;
  for (int n = 0; n < iterations; ++n) {
    Volume next = plain_membrane(energies, lambda, 0, 1, nullptr, edges, n);
    for (const auto [x, y] : positions_of(first.width, first.height)) {
      if (certainty_of(energies, x, y) > certainty_of(next, x, y)) {
        for (int i = 0; i < first.count(); ++i) {
          next.at(x, y, i) = energies.at(x, y, i);
        }
      }
    }
    energies = std::move(next);
  }
  return energies;
}

double plain_penalty(const MethodParameters& parameters, double k_squared) {
  const double epsilon = parameters.epsilon_prior;
  const double quadratic = k_squared / (2 * parameters.sigma_prior * parameters.sigma_prior);
  if (parameters.prior == Prior::kQuadratic) {
    return quadratic;
  }
  const double similar = parameters.prior == Prior::kContaminatedGaussian ? quadratic
                         : k_squared == 0                                 ? 0
                                          : std::numeric_limits<double>::infinity();
  if (parameters.prior_smoothing == PriorSmoothing::kMaximum) {
    return std::min(similar, std::max(0.0, std::log((1 - epsilon) / epsilon)));
  }
  return -std::log((1 - epsilon) * std::exp(-similar) + epsilon);
}

double plain_support(const std::vector<double>& penalties, const std::vector<double>& energies,
                     PriorSmoothing smoothing) {
  std::vector<double> exponents;
  for (std::size_t j = 0; j < penalties.size(); ++j) {
    exponents.push_back(-penalties[j] - energies[j]);
  }
  return smoothing == PriorSmoothing::kMaximum
             ? -*std::max_element(exponents.begin(), exponents.end())
             : -log_of_sum_of_exponentials(exponents);
}

Volume plain_bayes(const Volume& energies, const MethodParameters& parameters, const Volume* start,
                   const PlainEdges& edges) {
  Volume now = energies;
  if (start != nullptr) {
    std::transform(start->cells.begin(), start->cells.end(), now.cells.begin(),
                   [](double probability) { return -std::log(probability); });
  }
  for (int n = 0; n < parameters.iterations; ++n) {
    const Volume smooth = smooth_energies(now, parameters);
    for_each_cell(energies, [&](int x, int y, int i) {  // (6.37)
      double sum = smooth.at(x, y, i);
      for (const auto& [dx, dy] : kNeighbours) {
        if (is_inside(energies, x + dx, y + dy)) {
          sum += edges.weight(n + 1, x, y, x + dx, y + dy) * smooth.at(x + dx, y + dy, i);
        }
      }
      now.at(x, y, i) = energies.at(x, y, i) + parameters.mu * sum;
    });
    subtract_minima(now);
  }
  return probabilities_of(now);
}

}  // namespace test
}  // namespace vantage
