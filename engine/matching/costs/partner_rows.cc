#include "engine/matching/costs/partner_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/error.h"
#include "engine/matching/costs/grey_planes.h"

namespace vantage {
namespace {

using kernels::CandidateRange;
using kernels::CandidateShift;
using kernels::FeaturePairs;
using scheduler::Range;

/// Shifts of all lanes. Products that differ from an integer only by rounding become that integer.
std::vector<CandidateShift> shifts_of(const kernels::CandidateGeometry& geometry, double ratio) {
  constexpr double kRounding = 1e-9;
  std::vector<CandidateShift> shifts;
  for (int lane = 0; lane < geometry.lanes(); ++lane) {
    double shift = (geometry.disparity_min + lane) * ratio;
    if (std::abs(shift - std::round(shift)) < kRounding) {
      shift = std::round(shift);
    }
    const double whole = std::floor(shift);
    shifts.push_back({static_cast<int>(whole), static_cast<float>(shift - whole)});
  }
  return shifts;
}

}  // namespace

PartnerRows::PartnerRows(const CostImage& reference, const CostPartner& partner,
                         const kernels::CandidateGeometry& geometry)
    : reference_(reference),
      partner_(*partner.image),
      geometry_(geometry),
      rows_down_(geometry.direction * partner.disparity_y_px) {
  const double ratio = partner.baseline_ratio;
  constexpr double kMaxRatio = 1000;
  if (!(ratio != 0 && std::abs(ratio) <= kMaxRatio)) {
    throw UsageError(
        fmt::format("baseline is {} times the first one, expected a number from {} "
                    "to {}, not 0",
                    ratio, -kMaxRatio, kMaxRatio));
  }
  if (ratio < 0) {
    geometry_.direction = -geometry_.direction;
  }
  if (std::abs(ratio) != 1) {
    shifts_ = shifts_of(geometry_, std::abs(ratio));
  }
}

std::size_t PartnerRows::work_floats(int columns) const {
  return is_interpolated() ? static_cast<std::size_t>(channels()) *
                                 static_cast<std::size_t>(columns) * shifts_.size()
                           : 0;
}

int PartnerRows::channels() const { return std::max(reference_.channels(), partner_.channels()); }

bool PartnerRows::has_row(int y) const { return partner_row(y) == y + rows_down_; }

int PartnerRows::partner_row(int y) const {
  return std::clamp(y + rows_down_, 0, partner_.height() - 1);
}

int PartnerRows::position(int x) const { return mirrored() ? geometry_.width - 1 - x : x; }

CandidateRange PartnerRows::with_partner(int x) const {
  if (!is_interpolated()) {
    return geometry_.with_partner(x);
  }
  return kernels::candidates_inside(shifts_.data(), geometry_.count, geometry_.width, position(x));
}

CandidateRange PartnerRows::columns_with_all_partners() const {
  return is_interpolated() ? CandidateRange{} : geometry_.columns_with_all_partners();
}

FeaturePairs<float, 1> PartnerRows::intensities(int y, Range columns, float* work) const {
  FeaturePairs<float, 1> row = pairs(y, columns, &GreyPlanes::grey);
  if (!is_interpolated()) {
    return row;
  }
  row.partner_step = row.lanes;
  const auto& planes = static_cast<const GreyPlanes&>(partner_.planes());
  for (int c = 0; c < row.channels; ++c) {
    kernels::interpolate_candidates(
        {geometry_.width, position(columns.begin), step(), columns.size(), row.lanes},
        shifts_.data(), partner_pixels(planes.grey[channel_of(partner_, c)][0], y), work);
    row.channel[static_cast<std::size_t>(c)].partner[0] = work;
    work += static_cast<std::ptrdiff_t>(columns.size()) * row.lanes;
  }
  return row;
}

}  // namespace vantage
