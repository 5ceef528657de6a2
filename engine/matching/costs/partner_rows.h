#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "engine/matching/costs/cost_image.h"
#include "engine/matching/costs/cost_planes.h"
#include "kernels/candidate_interpolation/candidate_interpolation.h"
#include "kernels/candidates.h"
#include "kernels/feature_pairs.h"
#include "scheduler/range.h"

namespace vantage {

/// Rows of a reference image and of one partner, as kernels compare them. Thread rule: immutable.
class PartnerRows {
 public:
  /// `geometry`: of the map. Throws UsageError for a baseline ratio that is 0 or not finite.
  PartnerRows(const CostImage& reference, const CostPartner& partner,
              const kernels::CandidateGeometry& geometry);

  /// Whether partners lie between pixels or farther apart than the disparities: then only
  /// intensities can be compared.
  [[nodiscard]] bool is_interpolated() const { return !shifts_.empty(); }
  /// Floats of working memory that grey_levels() needs for this number of columns.
  [[nodiscard]] std::size_t work_floats(int columns) const;
  /// Number of compared channels: 1 or 3.
  [[nodiscard]] int channels() const;

  /// Whether the partners of row y lie inside the other image.
  [[nodiscard]] bool has_row(int y) const;
  /// Candidates of column x whose partner's column lies inside.
  [[nodiscard]] kernels::CandidateRange with_partner(int x) const;
  /// Columns where the partners of all candidates lie inside; begin may exceed end.
  [[nodiscard]] kernels::CandidateRange columns_with_all_partners() const;
  /// Candidates as counted in this partner, whose direction may be opposite. Not for interpolated
  /// partners.
  [[nodiscard]] const kernels::CandidateGeometry& geometry() const { return geometry_; }

  /// The first `used` of the cost's `planes` for every channel, at the columns of row y and at
  /// their partners. Rows outside are replaced by the nearest one. Not for interpolated partners.
  template <typename Planes, typename T, std::size_t kPlanes>
  [[nodiscard]] kernels::FeaturePairs<T, static_cast<int>(kPlanes)> pairs(
      int y, scheduler::Range columns,
      std::array<std::array<FeaturePlane<T>, kPlanes>, 3> Planes::*planes,
      std::size_t used = kPlanes) const {
    const auto& of_reference = static_cast<const Planes&>(reference_.planes()).*planes;
    const auto& of_partner = static_cast<const Planes&>(partner_.planes()).*planes;
    auto row = empty_pairs<T, kPlanes>(columns, channels());
    for (int c = 0; c < row.channels; ++c) {
      // With a colour image, a grey image has the same intensity in all channels.
      set_channel(of_reference[channel_of(reference_, c)], of_partner[channel_of(partner_, c)], y,
                  columns, used, row.channel[static_cast<std::size_t>(c)]);
    }
    return row;
  }
  /// As above, for planes of luma.
  template <typename Planes, typename T, std::size_t kPlanes>
  [[nodiscard]] kernels::FeaturePairs<T, static_cast<int>(kPlanes)> pairs(
      int y, scheduler::Range columns, std::array<FeaturePlane<T>, kPlanes> Planes::*planes) const {
    auto row = empty_pairs<T, kPlanes>(columns, 1);
    set_channel(static_cast<const Planes&>(reference_.planes()).*planes,
                static_cast<const Planes&>(partner_.planes()).*planes, y, columns, kPlanes,
                row.channel[0]);
    return row;
  }
  /// For costs that use GreyPlanes; interpolated in `work` if necessary.
  [[nodiscard]] kernels::FeaturePairs<float, 1> intensities(int y, scheduler::Range columns,
                                                            float* work) const;

 private:
  template <typename T, std::size_t kPlanes>
  [[nodiscard]] kernels::FeaturePairs<T, static_cast<int>(kPlanes)> empty_pairs(
      scheduler::Range columns, int channels) const {
    kernels::FeaturePairs<T, static_cast<int>(kPlanes)> row;
    row.channels = channels;
    row.partner_step = step();
    row.columns = columns.size();
    row.lanes = geometry_.lanes();
    row.count = geometry_.count;
    return row;
  }
  template <typename T, std::size_t kPlanes, typename Channel>
  void set_channel(const PlaneSet<T, kPlanes>& of_reference, const PlaneSet<T, kPlanes>& of_partner,
                   int y, scheduler::Range columns, std::size_t used, Channel& channel) const {
    const int offset = position(columns.begin) + geometry_.disparity_min;
    for (std::size_t p = 0; p < used; ++p) {
      channel.reference[p] = of_reference[p].plain.row(y) + columns.begin;
      channel.partner[p] = partner_pixels(of_partner[p], y) + offset;
    }
  }
  static std::size_t channel_of(const CostImage& image, int channel) {
    return static_cast<std::size_t>(std::min(channel, image.channels() - 1));
  }
  [[nodiscard]] int partner_row(int y) const;
  /// Position of column x at shift 0 in a row of the partner, mirrored or not.
  [[nodiscard]] int position(int x) const;
  [[nodiscard]] int step() const { return mirrored() ? -1 : 1; }
  [[nodiscard]] bool mirrored() const { return geometry_.direction < 0; }
  template <typename T>
  [[nodiscard]] const T* partner_pixels(const FeaturePlane<T>& plane, int y) const {
    return (mirrored() ? plane.mirrored : plane.plain).row(partner_row(y));
  }

  const CostImage& reference_;
  const CostImage& partner_;
  kernels::CandidateGeometry geometry_;
  int rows_down_;
  /// Per lane; empty if the shift is disparity_min + lane.
  std::vector<kernels::CandidateShift> shifts_;
};

}  // namespace vantage
