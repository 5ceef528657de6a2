#pragma once

#include <memory>
#include <span>

#include "engine/execution.h"
#include "engine/image/photograph.h"
#include "engine/matching/method_parameters.h"
#include "kernels/candidates.h"
#include "scheduler/row_stage.h"

namespace vantage {

/// How a photograph takes part in matching; decides which planes it needs.
struct CostImageUse {
  bool as_reference = true;
  /// As the other image of a left reference: rows mirrored, so that the partners of growing
  /// disparities lie at growing addresses.
  bool as_partner_of_left = true;
  bool as_partner_of_right = true;
};

/// Everything that costs look up in one photograph: grey levels or channels, gradients, census
/// codes, … with margins, so that every lane of every candidate can be loaded. Working memory,
/// reused from pair to pair without allocating.
class CostImage {
 public:
  CostImage();
  CostImage(CostImage&&) noexcept;
  CostImage& operator=(CostImage&&) noexcept;
  ~CostImage();

  /// Fills the planes `parameters.cost` needs. `geometry`: of a left-reference map; only its width,
  /// range and lanes count. Identical for any `execution`.
  void prepare(const Photograph& photograph, const MethodParameters& parameters,
               const kernels::CandidateGeometry& geometry, CostImageUse use, Execution& execution);

  struct Planes;
  [[nodiscard]] const Planes& planes() const { return *planes_; }

 private:
  std::unique_ptr<Planes> planes_;
};

/// One image the reference is compared with.
struct CostPartner {
  const CostImage* image = nullptr;
  /// The partner of column x is x + direction · disparity · baseline_ratio, interpolated linearly
  /// where it lies between pixels (6.6; Okutomi & Kanade). ≠ 0; negative: a camera on the other
  /// side.
  double baseline_ratio = 1;
  /// The partner's row is y + direction · disparity_y_px (5.5.3); rows outside replicate the border.
  int disparity_y_px = 0;
};

/// What the cells of a cost stage hold.
enum class CellMeaning {
  kEnergy,      ///< the cost, small = alike
  kLikelihood,  ///< p0 up to a factor per column, in (0, 1], large = alike (6.25)
};

/// Source stage: the disparity space E0 of (6.1), or the likelihood that Bayesian diffusion starts
/// from. Output cells are float, geometry.lanes() a column; the lanes beyond geometry.count are
/// finite (energies) or 0 (likelihoods). With several partners: the sum of their costs.
///
/// Energies: the costs of MatchCost in grey levels (of 0..255) to the power the cost has; evidence
/// is negated. A cell whose partner is outside has the cost of the clamped coordinate; evidence has
/// 0, the contaminated Gaussian −log ε.
/// Likelihoods: (1−ε) exp(−r²/2σ²) + ε, with r² = ΔI² for the squared and contaminated costs,
/// r = the cost for the others, and for evidence (1−ε) exp((E − max over the column)/σ) + ε, E of
/// the cells with a partner; ε where the partner is outside. With several partners: the product.
///
/// `reference`, `partners` and their planes must outlive the stage.
std::unique_ptr<scheduler::RowStage> make_cost_stage(const MethodParameters& parameters,
                                                     const kernels::CandidateGeometry& geometry,
                                                     const CostImage& reference,
                                                     std::span<const CostPartner> partners,
                                                     CellMeaning meaning, int height);

}  // namespace vantage
