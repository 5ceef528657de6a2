#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>

#include "engine/execution.h"
#include "engine/image/photograph.h"
#include "engine/matching/parameters/method_parameters.h"
#include "kernels/candidates.h"

namespace vantage {

class CostPlanes;
class EpipolarGrid;

/// Role of a photograph in matching; determines which planes it needs.
struct CostImageUse {
  bool as_reference = true;
  /// Use as partner of a left reference: rows are mirrored, so that partners of increasing
  /// disparities lie at increasing addresses.
  bool as_partner_of_left = true;
  bool as_partner_of_right = true;
  /// As a partner: samples per pixel, ≥ 1 (sample_phases()). Between pixels they are those of the
  /// image resampled there, see kernels/row_resampling.
  int phases = 1;
};

/// Everything that a cost reads of one photograph: luma or channel intensities, gradients, census
/// codes, … with margins, so that every lane of every candidate can be loaded. Working memory,
/// reused without allocation for further pairs with the same cost.
class CostImage {
 public:
  CostImage();
  CostImage(CostImage&&) noexcept;
  CostImage& operator=(CostImage&&) noexcept;
  ~CostImage();

  /// Fills the planes that `parameters.cost` needs. `geometry`: of a left-reference map; only its
  /// width, range and lanes are used. Identical for any `execution`.
  void prepare(const Photograph& photograph, const MethodParameters& parameters,
               const kernels::CandidateGeometry& geometry, CostImageUse use, Execution& execution);

  /// For a partner that is sampled where the reference needs it: `at_phases` are the image at x +
  /// index / at_phases.size(), of equal size.
  void prepare_samples(std::span<const Photograph> at_phases, const MethodParameters& parameters,
                       const kernels::CandidateGeometry& geometry, CostImageUse use,
                       Execution& execution);

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  [[nodiscard]] int channels() const { return channels_; }  ///< number of compared channels: 1 or 3
  [[nodiscard]] int phases() const { return phases_; }      ///< CostImageUse::phases
  /// The planes, of the cost's own type.
  [[nodiscard]] const CostPlanes& planes() const { return *planes_; }
  /// Bytes of all planes.
  [[nodiscard]] std::size_t held_bytes() const;

 private:
  void set_up(const Photograph& photograph, const MethodParameters& parameters, int phases);
  struct Phase {
    const Photograph& photograph;
    int index;
    bool is_sampled = false;  ///< the photograph has been sampled at the columns of the phase
  };
  void prepare_phase(const Phase& phase, const MethodParameters& parameters,
                     const kernels::CandidateGeometry& geometry, const CostImageUse& use,
                     Execution& execution);

  int width_ = 0;
  int height_ = 0;
  int channels_ = 1;
  int phases_ = 1;
  std::optional<MatchCost> cost_;  ///< the cost that `planes_` belong to
  std::unique_ptr<CostPlanes> planes_;
};

/// Samples per pixel of a partner for which all its candidates lie on samples, at most
/// kMaxSamplePhases: if more are needed, candidates are rounded to the nearest sample.
inline constexpr int kMaxSamplePhases = 16;
int sample_phases(double baseline_ratio, int steps_per_px);

/// An image that the reference is compared with.
struct CostPartner {
  /// With `epipolar` the first of its kPhases images, that of whole rows.
  const CostImage* image = nullptr;
  /// The partner of column x is x + direction · disparity · baseline_ratio (6.6; Okutomi & Kanade),
  /// rounded to the samples of the image. ≠ 0, of magnitude ≤ 1000; negative: a camera on the other
  /// side, whose image must be prepared as a partner of the other direction.
  double baseline_ratio = 1;
  /// The partner's row is y + direction · disparity_y_px (5.5.3). Partners in rows outside the
  /// image are treated like those in columns outside.
  int disparity_y_px = 0;
  /// Where the partners of photographs that are not rectified lie; null: in rows.
  const EpipolarGrid* epipolar = nullptr;
};

}  // namespace vantage
