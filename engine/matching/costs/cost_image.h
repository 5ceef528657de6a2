#pragma once

#include <cstddef>
#include <memory>
#include <optional>

#include "engine/execution.h"
#include "engine/image/photograph.h"
#include "engine/matching/costs/intensity_change.h"
#include "engine/matching/parameters/method_parameters.h"
#include "kernels/candidates.h"

namespace vantage {

class CostPlanes;

/// How a photograph takes part in matching; decides which planes it needs.
struct CostImageUse {
  bool as_reference = true;
  /// As the other image of a left reference: rows mirrored, so that the partners of growing
  /// disparities lie at growing addresses.
  bool as_partner_of_left = true;
  bool as_partner_of_right = true;
  /// Made to the grey levels before anything is made of them.
  IntensityChanges intensity_changes = {};
};

/// Everything that a cost looks up in one photograph: grey levels or channels, gradients, census
/// codes, … with margins, so that every lane of every candidate can be loaded. Working memory,
/// reused from pair to pair of one cost without allocating.
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

  [[nodiscard]] int height() const { return height_; }
  [[nodiscard]] int channels() const { return channels_; }  ///< that are compared: 1 or 3
  /// Of the type that the cost makes.
  [[nodiscard]] const CostPlanes& planes() const { return *planes_; }
  /// Bytes of all planes.
  [[nodiscard]] std::size_t held_bytes() const;

 private:
  int height_ = 0;
  int channels_ = 1;
  std::optional<MatchCost> cost_;  ///< whose planes they are
  std::unique_ptr<CostPlanes> planes_;
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

}  // namespace vantage
