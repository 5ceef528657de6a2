#include "tests/engine/plain_levels.h"
#include "tests/engine/engine_test.h"

namespace vantage {
inline namespace test {
namespace {

/// Calls visit(x, y) for every column.
template <typename Visit>
void for_each_column(const Volume& volume, Visit visit) {
  for (const auto [x, y] : positions_of(volume.width, volume.height)) {
    visit(x, y);
  }
}

/// Nearest number of 11 significant bits, and of none below 2^−24: a half float.
double nearest_half(double value) {
  int exponent = 0;
  std::frexp(value, &exponent);
  const int unit = std::max(exponent - 11, -24);
  return std::ldexp(std::nearbyint(std::ldexp(value, -unit)), unit);
}

/// Means over blocks of 2×2 columns, of those that are there.
Volume block_means(const Volume& finer) {
  Volume coarser = finer;
  coarser.is_coarse = true;
  coarser.width = (finer.width + 1) / 2;
  coarser.height = (finer.height + 1) / 2;
  coarser.cells.assign(static_cast<std::size_t>(coarser.width * coarser.height * finer.count()), 0);
  for_each_cell(coarser, [&](int x, int y, int i) {
    double sum = 0;
    int samples = 0;
    for (const auto [u, v] : positions_of({2 * x, std::min(2 * x + 2, finer.width)},
                                          {2 * y, std::min(2 * y + 2, finer.height)})) {
      sum += finer.at(u, v, i);
      ++samples;
    }
    coarser.at(x, y, i) = sum / samples;
  });
  return coarser;
}

/// Of ray census codes in bytes: the finest steps a nat of 8 … 128 that −ln ε fits in; 0: costs
/// are not in bytes.
int byte_steps(const Volume& costs, const MethodParameters& parameters) {
  if (costs.is_coarse) {
    return 8;
  }
  if (parameters.cost != MatchCost::kRayCensus || parameters.colour != ColourUse::kLuma) {
    return 0;
  }
  int steps = 128;
  while (steps > 8 && -std::log(parameters.epsilon_measurement) * steps > 255) {
    steps /= 2;
  }
  return steps;
}

/// Each energy, or that of an adjacent candidate plus the penalty if that is less.
void allow_slants(Volume& volume, double penalty) {
  const Volume upright = volume;
  for_each_cell(volume, [&](int x, int y, int i) {
    for (const int beside : {i - 1, i + 1}) {
      if (beside >= 0 && beside < volume.count()) {
        volume.at(x, y, i) = std::min(volume.at(x, y, i), upright.at(x, y, beside) + penalty);
      }
    }
  });
}

/// The level's weight times −log p0 of four columns, above the least of a column.
Volume block_sums(Volume finer, const MethodParameters& parameters, StoredCells stored) {
  const bool is_level_1 = !finer.is_coarse;
  double weight = parameters.level_weight;
  if (stored == StoredCells::kCompact) {
    const int steps = byte_steps(finer, parameters);
    for (double& energy : finer.cells) {
      energy = steps > 0 ? std::min(std::nearbyint(steps * energy), 255.0) / steps
                         : std::min(energy, 31 * std::log(2.0));
    }
    if (steps > 0) {  // from steps to steps, in multiples of 2^−14
      weight = std::nearbyint(16384 * weight * 8 / steps) / 16384 * steps / 8;
    }
  }
  Volume coarser = block_means(finer);
  for_each_column(coarser, [&](int x, int y) {
    double min = coarser.at(x, y, 0);
    for (int i = 0; i < coarser.count(); ++i) {
      min = std::min(min, coarser.at(x, y, i));
    }
    for (int i = 0; i < coarser.count(); ++i) {
      double& energy = coarser.at(x, y, i);
      energy = 4 * weight * (energy - min);
      if (stored == StoredCells::kCompact) {
        energy = std::min(std::floor(8 * energy + 0.5), 255.0) / 8;
      }
    }
  });
  if (!is_level_1 && std::isfinite(parameters.slant_penalty)) {
    const double penalty = parameters.slant_penalty / steps_per_px(parameters);
    allow_slants(coarser,
                 stored == StoredCells::kCompact ? std::nearbyint(8 * penalty) / 8 : penalty);
  }
  return coarser;
}

Volume reduced(const Volume& finer, const MethodParameters& parameters, StoredCells stored) {
  if (parameters.aggregation == Aggregation::kBayes) {
    return block_sums(finer, parameters, stored);
  }
  Volume coarser = block_means(finer);
  if (stored == StoredCells::kCompact) {
    std::transform(coarser.cells.begin(), coarser.cells.end(), coarser.cells.begin(), nearest_half);
  }
  return coarser;
}

/// Energies as bytes keep them: above the least of their column, up to where the prior's ceiling
/// lies, at least a nat; as far as bytes of probabilities reach where no iteration follows.
Volume in_bytes_to_ceiling(Volume energies, const MethodParameters& parameters) {
  const double epsilon = parameters.epsilon_prior;
  const double range = std::max(
      {std::log((1 - epsilon) / epsilon), 1.0, parameters.final_iterations == 0 ? 22.0 : 0.0});
  for_each_column(energies, [&](int x, int y) {
    double min = energies.at(x, y, 0);
    for (int i = 0; i < energies.count(); ++i) {
      min = std::min(min, energies.at(x, y, i));
    }
    for (int i = 0; i < energies.count(); ++i) {
      const double share = (energies.at(x, y, i) - min) / range;
      energies.at(x, y, i) = std::min(std::floor(255 * share + 0.5), 255.0) / 255 * range;
    }
  });
  return energies;
}

/// The result of a coarse level on the grid of the next finer one.
Volume expanded(const Volume& coarser, const Volume& finer, const MethodParameters& parameters,
                StoredCells stored) {
  const bool is_maximum = parameters.aggregation == Aggregation::kBayes &&
                          parameters.prior_smoothing == PriorSmoothing::kMaximum &&
                          parameters.prior != Prior::kQuadratic;
  const Volume stepped = is_maximum && stored == StoredCells::kCompact
                             ? in_bytes_to_ceiling(coarser, parameters)
                             : coarser;
  Volume result = finer;
  for_each_cell(result, [&](int x, int y, int i) {
    double energy = stepped.at(x / 2, y / 2, i);
    if (stored == StoredCells::kCompact && !is_maximum) {
      if (parameters.aggregation == Aggregation::kBayes) {
        energy = std::min(std::nearbyint(8 * energy / std::log(2.0)), 255.0) / 8 * std::log(2.0);
      } else {
        energy = nearest_half(energy);
      }
    }
    result.at(x, y, i) = energy;
  });
  return result;
}

Volume plain_bayes_level(const Volume& costs, const Volume* coarser,
                         const MethodParameters& parameters, const PlainEdges& edges) {
  Volume start;
  if (coarser != nullptr) {
    start = *coarser;
    for_each_column(start, [&](int x, int y) {
      double sum = 0;
      for (int i = 0; i < start.count(); ++i) {
        start.at(x, y, i) = std::exp(-start.at(x, y, i));
        sum += start.at(x, y, i);
      }
      for (int i = 0; i < start.count(); ++i) {
        start.at(x, y, i) /= sum;
      }
    });
  }
  Volume cells = plain_bayes(costs, parameters, coarser != nullptr ? &start : nullptr, edges);
  for (double& cell : cells.cells) {
    cell = -std::log(cell);
  }
  return cells;
}

}  // namespace

Volume plain_level(const Volume& costs, const Volume* coarser, const MethodParameters& parameters,
                   const Volume& grey) {
  const PlainEdges edges(grey, parameters);
  if (parameters.aggregation == Aggregation::kBayes) {
    return plain_bayes_level(costs, coarser, parameters, edges);
  }
  if (parameters.aggregation == Aggregation::kMembrane) {
    return plain_membrane(costs, parameters.lambda, parameters.beta, parameters.iterations, coarser,
                          edges);
  }
  Volume start = costs;
  if (coarser != nullptr) {
    for (std::size_t k = 0; k < start.cells.size(); ++k) {
      start.cells[k] = (start.cells[k] + coarser->cells[k]) / 2;
    }
  }
  switch (parameters.aggregation) {
    case Aggregation::kBox:
      return plain_box_mean(start, parameters.window_px, parameters.border);
    case Aggregation::kGaussian:
      return plain_convolution(start, gaussian_taps(parameters.aggregation_sigma_px));
    case Aggregation::kBoxCascade:
      return plain_convolution(start, box_cascade_taps(parameters.aggregation_sigma_px));
    case Aggregation::kDiffusion:
      return plain_diffusion(start, parameters.lambda, parameters.iterations, edges);
    case Aggregation::kLocalStopping:
      return plain_local_stopping(start, parameters.lambda, parameters.certainty,
                                  plain_entropy_scale(parameters), parameters.iterations, edges);
    default:
      return start;
  }
}

Volume plain_coarse_to_fine(const Volume& costs, const MethodParameters& parameters,
                            const Volume& grey, StoredCells stored) {
  MethodParameters of_level = parameters;
  if (parameters.levels > 1) {
    of_level.iterations = parameters.final_iterations;
  }
  if (parameters.levels <= 1 || (costs.width <= 2 && costs.height <= 2)) {
    return plain_level(costs, nullptr, of_level, grey);
  }
  MethodParameters of_coarser = parameters;
  --of_coarser.levels;
  of_coarser.final_iterations = parameters.iterations;  // for the image's own level only
  of_coarser.sigma_prior *= parameters.prior_growth;
  of_coarser.border = Border::kClip;
  const Volume coarser = expanded(plain_coarse_to_fine(reduced(costs, parameters, stored),
                                                       of_coarser, block_means(grey), stored),
                                  costs, parameters, stored);
  return plain_level(costs, &coarser, of_level, grey);
}

}  // namespace test
}  // namespace vantage
