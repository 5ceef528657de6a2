#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include "engine/execution.h"
#include "engine/image/photograph.h"
#include "engine/matching/costs/level_change.h"
#include "engine/matching/options/method_parameters.h"
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
  /// Made to the grey levels before anything is made of them.
  LevelChanges level_changes = {};
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

  /// What all planes take.
  [[nodiscard]] std::size_t held_bytes() const;

  struct Planes;
  [[nodiscard]] const Planes& planes() const { return *planes_; }

 private:
  std::unique_ptr<Planes> planes_;
};

/// One image the reference is compared with.
struct CostPartner {
  const CostImage* image = nullptr;
  /// The partner of column x is x + direction · disparity · baseline_ratio, interpolated linearly
  /// where it lies between pixels (6.6; Okutomi & Kanade). ≠ 0, of magnitude ≤ 1000; negative: a
  /// camera on the other side, whose image must be prepared as a partner of the other direction.
  double baseline_ratio = 1;
  /// The partner's row is y + direction · disparity_y_px (5.5.3). Partners in rows outside are
  /// outside like those in columns outside.
  int disparity_y_px = 0;
};

/// What the cells of a cost stage hold.
enum class CellMeaning {
  kEnergy,      ///< the cost, small = alike
  kLikelihood,  ///< p0 up to a factor per column, in (0, 1], large = alike (6.25)
};

/// Source stage: the disparity space E0 of (6.1), or the likelihood that Bayesian diffusion starts
/// from. Output cells are float, geometry.lanes() a column; the lanes beyond geometry.count are
/// finite (energies) or 0 (likelihoods).
///
/// Energies: the costs of MatchCost in grey levels (of 0..255) to the power the cost has; evidence
/// is negated. Of colour channels: the mean of their costs. A cell whose partner is outside has the
/// cost of the clamped coordinate; evidence has 0, the contaminated Gaussian −log ε, the combined
/// cost half of the most that its terms can be. With several partners: the sum of their costs.
/// Likelihoods: exp(−cost) of the contaminated cost, which is (1−ε) exp(−ΔI²/2σ²) + ε for one
/// channel; else (1−ε) exp(−r²/2σ²) + ε, with r² = the squared cost, r = any other cost, and for
/// evidence (1−ε) exp((E − max over the column)/σ) + ε, E of the cells with a partner; ε where the
/// partner is outside. Of the combined cost, whose energies are logarithms already: their
/// exponential, of cells without partner too. With several partners: the product.
///
/// `reference`, prepared as a reference, `partners` (at least one), prepared as partners of this
/// direction, and their planes must outlive the stage; all prepared with `parameters`, this range
/// and equal sizes. A grey image beside a colour one has the same level in all channels. Throws
/// UsageError for a baseline ratio out of range, and for one not ±1 with a cost that compares more
/// than grey levels: Birchfield–Tomasi, gradient, census, combined.
std::unique_ptr<scheduler::RowStage> make_cost_stage(const MethodParameters& parameters,
                                                     const kernels::CandidateGeometry& geometry,
                                                     const CostImage& reference,
                                                     std::span<const CostPartner> partners,
                                                     CellMeaning meaning, int height);

}  // namespace vantage
