#pragma once

#include "kernels/bayes_step/bayes_step.h"
#include "kernels/bayes_step/quadratic_step.h"
#include "kernels/candidates.h"
#include "kernels/cell_smoothing/cell_smoothing.h"
#include "kernels/census/census.h"
#include "kernels/evidence/gradient_norm.h"
#include "kernels/local_stopping_step/local_stopping_step.h"

namespace vantage::kernels {

// Work of the matching kernels, counted from their vector code, so that profiles can relate them to
// the machine's peak. When you change a kernel, update its numbers here.
//
// Operations are additions, multiplications, divisions, square roots, comparisons, minima and
// maxima of floats, doubles and integers; a multiply-add counts two. For census codes, exclusive or
// and bit counts are included. Not counted: conversions, shifts, signs, masks and selects. Columns
// near the image border, where candidates lack partners, count like all others.

/// Work per column of cells.
struct KernelWork {
  double operations = 0;             ///< per candidate
  double operations_per_column = 0;  ///< in addition to those
  /// 4-byte values loaded from or stored to rows of cells or pixels, per lane. Excludes working
  /// memory of a few columns, which stays in the level 1 cache.
  double values = 0;
  double values_per_column = 0;  ///< in addition to those

  friend constexpr KernelWork operator+(const KernelWork& a, const KernelWork& b) {
    return {a.operations + b.operations, a.operations_per_column + b.operations_per_column,
            a.values + b.values, a.values_per_column + b.values_per_column};
  }
};

// --- parts of kernels -------------------------------------------------------------------------

/// cells/exp_log-inl.h, cell_winner/logarithm-inl.h: operations per value.
inline constexpr double kExp2Operations = 17;
inline constexpr double kLogOperations = 24;
/// bayes_step/powers-inl.h; the power without clamping its exponent.
inline constexpr double kFusedPowerOperations = 13;
inline constexpr double kScaledLogOperations = 20;
inline constexpr double kDoubleLogOperations = 30;
/// Reduction (sum, minimum or maximum) of a column's sixteen partial results.
inline constexpr double kLaneTreeOperations = kLaneMultiple - 1;
/// The measurement model (6.26 ff.) for a squared residual.
inline constexpr double kMeasurementOperations = kExp2Operations + 3;

// --- costs ------------------------------------------------------------------------------------

/// A kernel over FeaturePairs: `operations` per channel, plus the mean over three channels.
constexpr KernelWork compare_work(double operations, int planes, int channels) {
  const double pixels = static_cast<double>(planes) * channels;
  const double mean = channels == 1 ? 0 : channels;
  return {channels * operations + mean, 0, pixels + 1, pixels};
}
/// In-place change of a cell.
constexpr KernelWork cell_work(double operations) { return {operations, 0, 2, 0}; }

constexpr KernelWork squared_work(int channels) { return compare_work(2, 1, channels); }
constexpr KernelWork absolute_work(int channels) { return compare_work(2, 1, channels); }
/// Two distances of four operations each, and their minimum.
constexpr KernelWork sampling_insensitive_work(int channels) {
  return compare_work(9, 3, channels);
}
constexpr KernelWork contaminated_energy_work(int channels) {
  return compare_work(2 + kMeasurementOperations + kLogOperations + 1, 1, channels);
}
constexpr KernelWork contaminated_likelihood_work(int channels) {
  return squared_work(channels) + KernelWork{kMeasurementOperations};
}
/// Two differences, their norm, and its difference to the two half norms.
constexpr KernelWork negated_evidence_work(EvidenceNorm norm, int channels) {
  const bool is_across = norm == EvidenceNorm::kAcross;
  const int of_norm = norm == EvidenceNorm::kOctagon ? 5 : norm == EvidenceNorm::kL2 ? 4 : 1;
  return compare_work((is_across ? 3 : 4 + of_norm), is_across ? 2 : 3, channels);
}
/// Two exclusive ors and byte bit counts, and three additions of those counts.
constexpr KernelWork hamming_work(int channels) { return compare_work(7, 2, channels); }
/// Same per byte (a quarter of a value), for each channel, plus the mean over three channels. With
/// three thresholds two numbers have their bits counted, one of them with weight 2.
constexpr KernelWork ray_hamming_work(int channels, int thresholds) {
  const double bytes = static_cast<double>(channels) * ray_census_bytes(thresholds);
  const double sums = bytes - (thresholds == 1 ? 1 : 0);
  const double mean = channels * thresholds == 1 ? 0 : 1;
  return {2 * bytes + sums + mean, 0, bytes / 4 + 1, bytes / 4};
}
/// One channel. Values are looked up by distance in a table of two or five parts; the part is
/// selected by its first distance.
constexpr KernelWork ray_census_look_up_work(int thresholds, double values_per_cell) {
  const double bytes = ray_census_bytes(thresholds);
  const double choices = thresholds == 1 ? 1 : 4;
  return {2 * bytes + bytes - (thresholds == 1 ? 1 : 0) + choices, 0, bytes / 4 + values_per_cell,
          bytes / 4};
}
constexpr KernelWork ray_census_likelihood_work(int thresholds) {
  return ray_census_look_up_work(thresholds, 1);
}
constexpr KernelWork ray_census_energy_work(int thresholds) {
  return ray_census_look_up_work(thresholds, 0.25);
}

inline constexpr KernelWork kLikelihoodOfCostsWork = cell_work(1 + kMeasurementOperations);
inline constexpr KernelWork kLikelihoodOfEnergiesWork = cell_work(1 + kExp2Operations);
/// Starts with the column's minimum.
inline constexpr KernelWork kLikelihoodOfEvidenceWork =
    cell_work(4 + kExp2Operations) + KernelWork{1, kLaneTreeOperations, 1, 0};
/// choose_energies_row(), choose_likelihoods_row(): each partner is sorted into half of them.
inline constexpr KernelWork choose_partners_work(int partners, bool likelihoods) {
  const int half = (partners + 1) / 2;
  return cell_work(partners * (2 * half + 2 + (likelihoods ? kLogOperations : 0)) + 4 * half + 3 +
                   (likelihoods ? kExp2Operations + 1 : 0)) +
         KernelWork{0, 0, 1.0 * partners, 0};
}
/// One plane: a sample and its offset per lane.
inline constexpr KernelWork kGatherCandidatesWork = {1, 0, 3, 0};

/// Mean and minimum of the column, then the parabola of four operations.
inline constexpr KernelWork kEnergiesWithPriorWork =
    cell_work(5 + 2) + KernelWork{2, 2 * kLaneTreeOperations + 9, 1, 1};
inline constexpr KernelWork kLikelihoodsWithPriorWork =
    cell_work(5 + 1 + kExp2Operations + 1) + KernelWork{0, 4, 0, 1};

// --- box sums ---------------------------------------------------------------------------------

/// 16-bit pairs (entering, leaving): differences, their product with (1, −1), the multiply-add of
/// pairs, and the running sum. Interleaving loads two bytes and stores four per pixel of each
/// image.
inline constexpr KernelWork kColumnSsdPairsWork = {8, 0, 3, 1 + 3};
/// Per row: a difference, its square, rounding; then the running sum.
inline constexpr KernelWork kColumnSsdFloatWork = {2 * 3 + 2, 0, 4, 2};
/// Per row: offset, scale, rounding; then the running sum.
inline constexpr KernelWork kColumnSumWork = {2 * 3 + 2, 0, 4, 0};

/// One column enters the window and one leaves it; minima are taken along the way.
constexpr KernelWork row_sum_work(bool stores_sums) {
  return {3, kLaneTreeOperations, stores_sums ? 3.0 : 2.0, 0};
}
inline constexpr KernelWork kLocateMinimaWork = {1, kLaneTreeOperations, 1, 0};
inline constexpr KernelWork kMeanEnergyWork = {2, 1, 2, 0};
/// The winner only; the result is stored.
inline constexpr KernelWork kWinnerEnergyWork = {0, 4, 0, 1};

// --- smoothing --------------------------------------------------------------------------------

/// The middle run, then pairs of runs.
constexpr KernelWork symmetric_sum_work(int radius) {
  return {1 + 3.0 * radius, 0, 2.0 * radius + 2, 0};
}
/// Sum over the rows, then three boxes of three (two additions each), one of five (three) and the
/// gain.
inline constexpr KernelWork kBoxCascadeWork = {1 + 3.0 * BoxCascade::kRadius + 3 * 2 + 3 + 1, 0,
                                               2 * BoxCascade::kRadius + 2, 0};

// --- iterations -------------------------------------------------------------------------------

/// Five cells of a star and the result.
inline constexpr double kStarValues = 6;

/// weighted: each neighbour is multiplied by its weight; weights are loaded per column.
constexpr KernelWork diffusion_work(bool weighted) {
  return weighted ? KernelWork{9, 4 + 4, kStarValues, 4} : KernelWork{6, 0, kStarValues, 0};
}
/// Diffusion plus the pull towards the source.
constexpr KernelWork membrane_work(bool weighted) {
  return diffusion_work(weighted) + KernelWork{2, weighted ? 1.0 : 0.0, 1, 0};
}

/// Certainty of a column that is read again `loads` times.
constexpr KernelWork certainty_work(CertaintyMeasure measure, int loads) {
  if (measure == CertaintyMeasure::kMargin) {
    // Minimum, second minimum and sum; then their trees, and the tree that counts ties.
    return {4, 4 * kLaneTreeOperations + 2 * kLaneMultiple + 4, 1.0 * loads, 0};
  }
  // Minimum; exponent, weight, whether it is 1 and three sums.
  return {1 + 3 + kExp2Operations + 5, 4 * kLaneTreeOperations + 10 + kLogOperations, 1.0 * loads,
          0};
}
/// carries: whether input and output columns store their certainty after their lanes. Columns that
/// keep their cells (up to two more values per lane) depend on the images and are not counted.
constexpr KernelWork local_stopping_work(CertaintyMeasure measure, bool input_carries,
                                         bool output_carries, bool weighted) {
  const bool margin = measure == CertaintyMeasure::kMargin;
  KernelWork work = diffusion_work(weighted) + KernelWork{0, 1, 0, 0};
  // The result's margin is computed together with the result.
  work = work + certainty_work(measure, margin ? 0 : 2);
  work = work + (input_carries ? KernelWork{0, 0, 0, 1} : certainty_work(measure, margin ? 1 : 2));
  return output_carries ? work + KernelWork{0, 0, 0, kCertaintyFloats} : work;
}

/// Normalises a column and stores it as `state`.
constexpr KernelWork bayes_state_work(BayesState state, int prior_radius) {
  const double sum = 1;
  const double normalise = kLaneTreeOperations + 1;
  if (state == BayesState::kProbability) {
    return {sum + 1, normalise, 0, 0};
  }
  const double smooth = 1 + 3.0 * prior_radius + 2;
  return {sum + smooth + (state == BayesState::kLogSmoothed ? kScaledLogOperations : 0), normalise,
          0, 0};
}
constexpr KernelWork bayes_start_work(BayesState state, int prior_radius) {
  return bayes_state_work(state, prior_radius) + KernelWork{0, 0, 2, 0};
}
/// Four products of the star, the estimate of the square root and its Newton step, two products.
/// Where the prior has one tap and columns stay in registers, the tap is folded into the
/// normalising factor: one operation fewer than counted here.
constexpr KernelWork bayes_half_work(BayesState state, int prior_radius) {
  return bayes_state_work(state, prior_radius) + KernelWork{4 + 1 + 3 + 2, 0, kStarValues + 1, 0};
}
/// Sum of the star, power, product. scaled: first the column's maximum sum; powers are clamped at a
/// minimum exponent. weighted: four neighbours are multiplied by weights, which are loaded per
/// column.
constexpr KernelWork bayes_general_work(BayesState state, int prior_radius, bool scaled,
                                        bool weighted) {
  const double sum = weighted ? 8 : 4;
  const KernelWork work =
      bayes_state_work(state, prior_radius) +
      KernelWork{sum + kFusedPowerOperations + 1, 0, kStarValues + 1, weighted ? 4.0 : 0.0};
  return scaled ? work + KernelWork{sum + 1 + 1 + 1, kLaneTreeOperations, kStarValues - 1, 0}
                : work;
}

/// A logarithm of the likelihood, the sum of the star and its shift below 0; then offsets to
/// candidates on both sides, as many as the images make worth looking at, of which eight are
/// counted: maximum, rise and comparison, for the sum also two powers; or a power and the
/// normalisation.
constexpr KernelWork quadratic_work(bool smooths, bool largest_term, bool is_start, bool weighted) {
  constexpr double kOffsets = 8;
  const double offset = largest_term ? 4 : 4 + 6 + 2 * kExp2Operations;
  const double result = smooths ? kOffsets * offset + (largest_term ? 0 : kLogOperations + 1) + 1
                                : kExp2Operations + 3;
  const double star = is_start ? 0 : weighted ? 8 : 4;
  return {kLogOperations + 2 + star + 3 + result, kLaneTreeOperations,
          is_start ? 2 : kStarValues + 1, weighted ? 4.0 : 0.0};
}

/// Fixed-point energies, half a value per cell. Subtracts the column's minimum. With `smooths`, for
/// each offset: minimum of two neighbours, plus the rise, running minimum; then the ceiling.
constexpr KernelWork energy_state_work(int prior_radius, bool smooths) {
  return {1 + 1 + (smooths ? 3.0 * prior_radius + 1 : 0), kLaneTreeOperations, 0, 0};
}
constexpr KernelWork max_product_start_work(int prior_radius) {
  return energy_state_work(prior_radius, true) + KernelWork{0, 0, 2 * 0.5, 0};
}
/// Five weighted cells (a product and a rounding each), their sum, and the source. Weights, if any,
/// are loaded per column.
constexpr KernelWork max_product_work(int prior_radius, bool smooths, bool weighted) {
  return energy_state_work(prior_radius, smooths) +
         KernelWork{5 * 2 + 4 + 1, 0, (kStarValues + 1) * 0.5, weighted ? 4 * 0.5 : 0.0};
}

// --- levels -----------------------------------------------------------------------------------

/// Per coarse column: minimum likelihood clamp, product of four, logarithm and maximum; then the
/// difference in steps, clamped. A byte is a quarter of a value.
inline constexpr KernelWork kReduceLikelihoodsWork = {4 + 3 + kLogOperations + 1 + 3,
                                                      kLaneTreeOperations, 4 + 0.25, 0};
/// Same for bytes: sum and minimum, then the difference times the weight.
inline constexpr KernelWork kReduceCompactEnergiesWork = {3 + 1 + 2, kLaneTreeOperations,
                                                          4 * 0.25 + 0.25, 0};
/// Two minima and a sum per cell, in place.
inline constexpr KernelWork kAllowSlantWork = {3, 0, 2 * 0.25, 0};
/// As kReduceCompactEnergiesWork for both images: one sum more, for pairs of columns that begin at
/// odd ones.
inline constexpr KernelWork kReducePairEnergiesWork = {2 * (3 + 1 + 2) + 1, 2 * kLaneTreeOperations,
                                                       4 * 0.25 + 2 * 0.25, 0};
inline constexpr KernelWork kExpandCompactWork = {1 + kExp2Operations, 0, 0.25 + 1, 0};
inline constexpr KernelWork kCompactProbabilitiesWork = {1 + kLogOperations + 3, 0, 1 + 0.25, 0};
/// Starts four columns from one column of the coarser level: computed once, then copied along the
/// row and to the row below.
constexpr KernelWork bayes_start_from_coarser_work(BayesState state, int prior_radius) {
  const KernelWork work = kExpandCompactWork + bayes_state_work(state, prior_radius);
  return {work.operations / 4, work.operations_per_column / 4, 2, 0};
}

/// A product and a rounding.
inline constexpr KernelWork kFixedEnergiesOfBytesWork = {2, 0, 0.25 + 0.5, 0};
/// Minimum likelihood clamp, logarithm in steps, clamped at 0.
inline constexpr KernelWork kFixedEnergiesOfLikelihoodsWork = {1 + kLogOperations + 2, 0, 1 + 0.5,
                                                               0};
/// As for bytes; these conversions saturate.
inline constexpr KernelWork kBytesOfFixedEnergiesWork = {2, 0, 0.5 + 0.25, 0};
/// See bayes_start_from_coarser_work().
constexpr KernelWork max_product_start_from_coarser_work(int prior_radius) {
  const KernelWork work = kFixedEnergiesOfBytesWork + energy_state_work(prior_radius, true);
  return {work.operations / 4, work.operations_per_column / 4, 2 * 0.5, 0};
}

/// Rounds a magnitude to a half float: maximum, exponent, two additions.
inline constexpr double kToHalfOperations = 4;
inline constexpr KernelWork kReduceEnergiesWork = {3 + 1 + kToHalfOperations, 0, 4 + 0.5, 0};
inline constexpr KernelWork kHalfEnergiesWork = {1 + kToHalfOperations, 0, 1 + 0.5, 0};
/// Exponent and unit.
inline constexpr KernelWork kExpandHalfWork = {2, 0, 0.5 + 1, 0};
/// Plus the mean with the level's own energies.
inline constexpr KernelWork kCoarserSupportWork = kExpandHalfWork + KernelWork{2, 0, 1, 0};

// --- selection --------------------------------------------------------------------------------

/// Minimum cell of a column. `places`: also its position, which reads the cells again.
constexpr KernelWork cell_winner_work(bool places, bool margin) {
  KernelWork work = {1, kLaneTreeOperations, 1, 1};
  if (places) {
    work = work + KernelWork{1, kLaneTreeOperations, 1, 1};
  }
  if (margin) {
    // Second minimum and sum, and their trees (three more operations to merge two pairs of minima).
    work = work + KernelWork{3, 4 * kLaneTreeOperations + 5, 0, 1};
  }
  return work;
}
inline constexpr KernelWork kCellEntropyWork = {3 + kExp2Operations + 3,
                                                2 * kLaneTreeOperations + 6 + kLogOperations, 1, 2};
inline constexpr KernelWork kIntegerDisparityWork = {0, 1, 0, 2};
/// Uses three cells of each column.
constexpr KernelWork parabola_work(bool of_probabilities) {
  return {0, 14 + (of_probabilities ? 3 * (kDoubleLogOperations + 1) : 0), 0, 5};
}
/// Minimum of a column of fixed-point energies, then its first position; positions are counted
/// along the way.
constexpr KernelWork energy_winner_work() {
  return {1 + 3, 2 * kLaneTreeOperations, 2 * 0.5, 1 + 0.5};
}
/// Uses three cells of each column, if the winner has neighbours.
inline constexpr KernelWork kEnergyDisparityWork = {0, 3 + 9, 0, 2 + 3 * 0.5};
/// Likelihoods of the column, their sum, and the winner's share.
inline constexpr KernelWork kEnergyProbabilityWork = {
    1 + kExp2Operations + 1, kLaneTreeOperations + kExp2Operations + 2, 0.5, 1 + 0.5};
/// Of energies: each pass adds one cost to the minimum of two neighbours and compares; then limit,
/// minimum of the column before, energy, candidates (two comparisons) and minimum. The path is
/// traced back through a few cells of each column.
constexpr KernelWork scanline_work(int passes) {
  return {3.0 * passes + 6, kLaneTreeOperations + 3.0 * (passes + 1), 2, 2};
}
/// Energies in steps: offset, scale, rounding, two limits.
inline constexpr KernelWork kStepEnergiesWork = {5, 0, 1 + 0.5, 0};
/// Per state, of which there is one for each candidate: minimum of two sums and a penalty, two
/// cells and an offset, minimum.
inline constexpr KernelWork kSymmetricPathWork = {6, 4, 3 + 2 * 0.5, 4};

}  // namespace vantage::kernels
