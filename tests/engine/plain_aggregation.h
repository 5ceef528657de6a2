#pragma once

#include "tests/engine/engine_test.h"
#include "tests/engine/plain_costs.h"

namespace vantage {
inline namespace test {

/// Mean over the samples of a square window that lie inside both images (EQUATIONS §1; Fig. 1.11);
/// NaN where a cell is no candidate: its partner, or with `valid` any of its window's, is outside.
Volume plain_box_mean(const Volume& costs, int window_px, Border border);

/// Convolution with a kernel of odd length in x and in y, cells outside the image being 0 (5.4).
Volume plain_convolution(const Volume& costs, const std::vector<double>& taps);
/// Sampled, normalised, radius ⌈4σ⌉.
std::vector<double> gaussian_taps(double sigma_px);
/// Wells: the convolution of four box filters of odd widths whose variances, (w² − 1)/12, add up to
/// σ² as nearly as they can; of several choices the one nearest to a Gaussian, whose fourth
/// cumulant is 0: the least Σ w⁴. σ = 2: 3, 3, 3, 5.
std::vector<double> box_cascade_taps(double sigma_px);

/// Weights of neighbours by the intensity edge between them (7.3), in each iteration of a level; by
/// default all are 1.
class PlainEdges {
 public:
  PlainEdges() = default;
  /// `grey`: one cell per pixel. `parameters`: of the level.
  PlainEdges(const Volume& grey, const MethodParameters& parameters);

  /// Of pixels (x, y) and (u, v) for each other in iteration n, 1 being the first.
  [[nodiscard]] double weight(int n, int x, int y, int u, int v) const;

 private:
  std::vector<Volume> grey_;  ///< as the first iterations see it, and all after them
  double min_ = 1;
  double contrast_ = 1;
};

/// (6.7), `iterations` times.
Volume plain_diffusion(const Volume& first, double lambda, int iterations,
                       const PlainEdges& edges = {});
/// (6.9), `iterations` times, from `start`; null: from `first`. `done`: iterations before.
Volume plain_membrane(const Volume& first, double lambda, double beta, int iterations,
                      const Volume* start = nullptr, const PlainEdges& edges = {}, int done = 0);

/// How distinct the least cell of a column is, over all its cells: (6.13), or (6.15) with
/// p ∝ exp(−scale · (E − Emin)). A single cell has the margin 0.
double plain_margin(const std::vector<double>& column);
double plain_negative_entropy(const std::vector<double>& column, double scale);

/// Local stopping (EQUATIONS §3.4): restores the columns whose certainty diffusion would reduce.
Volume plain_local_stopping(const Volume& first, double lambda, Certainty certainty, double scale,
                            int iterations, const PlainEdges& edges = {});

/// ρP (6.18) of an offset of k pixels, in a two-dimensional search the length of that. With the
/// largest term contamination is a term of its own, and 1 − εP is left out.
double plain_penalty(const MethodParameters& parameters, double k_squared);
/// −log of Σ_j exp(−penalties[j] − energies[j]), or of its largest term.
double plain_support(const std::vector<double>& penalties, const std::vector<double>& energies,
                     PriorSmoothing smoothing);

/// Probabilities after Bayesian diffusion (6.25)–(6.37), in logarithms, for any μ. `start`: what
/// the first iteration takes for the probabilities; null: those of the energies.
Volume plain_bayes(const Volume& energies, const MethodParameters& parameters,
                   const Volume* start = nullptr, const PlainEdges& edges = {});
/// The unit of costs in entropies (6.15): 1 ÷ (2 σM²), of evidence 1 ÷ σM.
inline double plain_entropy_scale(const MethodParameters& parameters) {
  return parameters.cost == MatchCost::kGradient
             ? 1 / parameters.sigma_measurement
             : 1 / (2 * parameters.sigma_measurement * parameters.sigma_measurement);
}

}  // namespace test
}  // namespace vantage
