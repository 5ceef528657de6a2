#include "tests/engine/plain_matching.h"

#include "engine/matching/costs/cost_table.h"
#include "tests/engine/engine_test.h"

namespace vantage {
inline namespace test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// (5.12), max p, (6.13) or (6.15); over the candidates, whose energies are `candidates`.
double confidence_of(const std::vector<double>& candidates, double min,
                     const MethodParameters& parameters) {
  if (parameters.aggregation == Aggregation::kBayes) {
    return std::exp(-min);
  }
  if (parameters.aggregation == Aggregation::kLocalStopping) {
    return parameters.certainty == Certainty::kMargin
               ? plain_margin(candidates)
               : plain_negative_entropy(candidates, plain_entropy_scale(parameters));
  }
  return is_evidence(parameters) ? -min : plain_margin(candidates);
}

PlainChoice choose(const Volume& energies, int x, int y, const MethodParameters& parameters) {
  const auto energy_at = [&](int i) {
    return i >= 0 && i < energies.count() && energies.has_partner(x, i) ? energies.at(x, y, i)
                                                                        : kNan;
  };
  PlainChoice choice{kNan, kNan, kNan, kNan, std::numeric_limits<double>::infinity(), kNan};
  std::vector<double> candidates;
  int best = -1;
  for (int i = 0; i < energies.count(); ++i) {
    const double energy = energy_at(i);
    if (std::isnan(energy)) {
      continue;
    }
    candidates.push_back(energy);
    if (best < 0 || energy < choice.energy) {
      choice.runner_up = best < 0 ? choice.runner_up : choice.energy;
      choice.energy = energy;
      best = i;
    } else {
      choice.runner_up = std::min(choice.runner_up, energy);
    }
  }
  if (best < 0) {
    choice.runner_up = kNan;
    return choice;
  }
  choice.winner = energies.disparity_px(best);
  choice.disparity = choice.winner;
  if (parameters.subpixel == Subpixel::kParabola) {
    const double below = energy_at(best - 1);
    const double above = energy_at(best + 1);
    choice.curvature = below - 2 * choice.energy + above;
    if (choice.curvature > 0) {  // false when a neighbour is no candidate
      choice.disparity += (below - above) / (2 * choice.curvature) / energies.steps;
    }
  }
  choice.confidence = confidence_of(candidates, choice.energy, parameters);
  return choice;
}

}  // namespace

Volume plain_aggregate(const Photograph& reference, const Photograph& other, Side reference_is,
                       DisparityRange range, const MethodParameters& parameters,
                       StoredCells stored) {
  return plain_coarse_to_fine(
      parameters.aggregation == Aggregation::kBayes
          ? plain_measurement_energies(reference, other, reference_is, range, parameters)
          : plain_costs(reference, other, reference_is, range, parameters),
      parameters, plain_grey(reference), stored);
}

PlainMap plain_select(const Volume& energies, const MethodParameters& parameters) {
  PlainMap map{energies.width, energies.height, {}};
  for (const auto [x, y] : positions_of(energies.width, energies.height)) {
    map.choices.push_back(choose(energies, x, y, parameters));
  }
  return map;
}

DisparityRange possible_range(DisparityRange range, int width_px) {
  return {std::max(range.min, 1 - width_px), std::min(range.max, width_px - 1)};
}

PlainMap plain_match(const Photograph& left, const Photograph& right, Side reference,
                     DisparityRange range, const MethodParameters& parameters, StoredCells stored) {
  const bool is_left = reference == Side::kLeft;
  return plain_select(plain_aggregate(is_left ? left : right, is_left ? right : left, reference,
                                      possible_range(range, left.width()), parameters, stored),
                      parameters);
}

}  // namespace test
}  // namespace vantage
