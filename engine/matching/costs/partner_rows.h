#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/matching/costs/cost_planes.h"
#include "engine/matching/costs/stage_cost.h"
#include "kernels/candidate_interpolation/candidate_interpolation.h"
#include "kernels/candidates.h"
#include "kernels/census/census.h"
#include "kernels/feature_pairs.h"
#include "scheduler/range.h"

namespace vantage {

/// Rows of a reference image beside rows of one partner, as kernels compare them. Thread rule:
/// immutable.
class PartnerRows {
 public:
  /// `geometry`: of the map. Throws UsageError for a baseline ratio that is 0 or not finite.
  PartnerRows(const CostImage& reference, const CostPartner& partner,
              const kernels::CandidateGeometry& geometry);

  /// Whether partners lie between pixels, or farther apart than disparities do: only grey levels
  /// can be compared then.
  [[nodiscard]] bool is_interpolated() const { return !shifts_.empty(); }
  /// Floats of working memory that grey_levels() needs for so many columns.
  [[nodiscard]] std::size_t work_floats(int columns) const;
  /// Of images that are compared: 1 or 3.
  [[nodiscard]] int channels() const;

  /// Whether the partners of row y lie inside the other image.
  [[nodiscard]] bool has_row(int y) const;
  /// Candidates of column x whose partners lie inside, as far as columns go.
  [[nodiscard]] kernels::CandidateRange with_partner(int x) const;
  /// Columns where all do; begin may exceed end.
  [[nodiscard]] kernels::CandidateRange columns_with_all_partners() const;
  /// The candidates as they are counted in this partner: its direction may be the other one. Not
  /// for interpolated partners.
  [[nodiscard]] const kernels::CandidateGeometry& geometry() const { return geometry_; }

  /// The first `kPlanes` feature planes, or census codes, of the columns of row y and of their
  /// partners; of rows outside, the nearest one's. Not for interpolated partners.
  template <int kPlanes>
  [[nodiscard]] kernels::FeaturePairs<float, kPlanes> features(int y,
                                                               scheduler::Range columns) const;
  [[nodiscard]] kernels::CensusPairs codes(int y, scheduler::Range columns) const;
  /// thresholds: those the images were prepared with.
  [[nodiscard]] kernels::RayCensusPairs ray_codes(int y, scheduler::Range columns,
                                                  int thresholds) const;
  /// The planes of the combined cost; gradients and the codes there are of one channel.
  [[nodiscard]] kernels::FeaturePairs<std::uint16_t, 3> fixed_levels(
      int y, scheduler::Range columns) const;
  [[nodiscard]] kernels::FeaturePairs<std::uint16_t, 2> fixed_gradients(
      int y, scheduler::Range columns) const;
  [[nodiscard]] kernels::CensusPairs luma_codes(int y, scheduler::Range columns) const;
  /// The first feature plane; interpolated in `work` where necessary.
  [[nodiscard]] kernels::FeaturePairs<float, 1> grey_levels(int y, scheduler::Range columns,
                                                            float* work) const;

 private:
  /// `planes`: how many there are, the first ones of kPlanes.
  template <typename T, int kPlanes, typename PlanesOfChannel>
  kernels::FeaturePairs<T, kPlanes> pairs(int y, scheduler::Range columns, int channels,
                                          const PlanesOfChannel& planes_of_channel,
                                          std::size_t planes = kPlanes) const;
  [[nodiscard]] int partner_row(int y) const;
  /// Where a shift of 0 leads from column x in a row of the partner, mirrored or not.
  [[nodiscard]] int position(int x) const;
  [[nodiscard]] int step() const { return mirrored() ? -1 : 1; }
  [[nodiscard]] bool mirrored() const { return geometry_.direction < 0; }
  template <typename T>
  [[nodiscard]] const T* partner_pixels(const FeaturePlane<T>& plane, int y) const {
    return (mirrored() ? plane.mirrored : plane.plain).row(partner_row(y));
  }

  const CostImage::Planes& reference_;
  const CostImage::Planes& partner_;
  kernels::CandidateGeometry geometry_;
  int rows_down_;
  /// Of every lane; empty where disparity_min + lane is the shift.
  std::vector<kernels::CandidateShift> shifts_;
};

}  // namespace vantage
