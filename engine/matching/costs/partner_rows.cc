#include "engine/matching/costs/partner_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/error.h"

namespace vantage {
namespace {

using kernels::CandidateRange;
using kernels::CandidateShift;
using kernels::FeaturePairs;
using scheduler::Range;

/// Shifts of all lanes. A product that misses a whole number only by rounding is that number.
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
    : reference_(reference.planes()),
      partner_(partner.image->planes()),
      geometry_(geometry),
      rows_down_(geometry.direction * partner.disparity_y_px) {
  const double ratio = partner.baseline_ratio;
  constexpr double kMostRatio = 1000;
  if (!(ratio != 0 && std::abs(ratio) <= kMostRatio)) {
    throw UsageError(
        fmt::format("baseline is {} times the first one, expected a number from {} "
                    "to {}, not 0",
                    ratio, -kMostRatio, kMostRatio));
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

int PartnerRows::channels() const { return std::max(reference_.channels, partner_.channels); }

bool PartnerRows::has_row(int y) const { return partner_row(y) == y + rows_down_; }

int PartnerRows::partner_row(int y) const {
  return std::clamp(y + rows_down_, 0, partner_.height - 1);
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

template <typename T, int kPlanes, typename PlanesOfChannel>
FeaturePairs<T, kPlanes> PartnerRows::pairs(int y, Range columns, int channels,
                                            const PlanesOfChannel& planes_of_channel,
                                            std::size_t planes) const {
  FeaturePairs<T, kPlanes> row;
  row.channels = channels;
  row.partner_step = step();
  row.columns = columns.size();
  row.lanes = geometry_.lanes();
  row.count = geometry_.count;
  const int offset = position(columns.begin) + geometry_.disparity_min;
  for (int c = 0; c < row.channels; ++c) {
    // A grey image beside a colour image has the same level in all channels.
    const auto& of_reference = planes_of_channel(reference_, std::min(c, reference_.channels - 1));
    const auto& of_partner = planes_of_channel(partner_, std::min(c, partner_.channels - 1));
    auto& channel = row.channel[static_cast<std::size_t>(c)];
    for (std::size_t p = 0; p < planes; ++p) {
      channel.reference[p] = of_reference[p].plain.row(y) + columns.begin;
      channel.partner[p] = partner_pixels(of_partner[p], y) + offset;
    }
  }
  return row;
}

template <int kPlanes>
FeaturePairs<float, kPlanes> PartnerRows::features(int y, Range columns) const {
  return pairs<float, kPlanes>(
      y, columns, channels(), [](const CostImage::Planes& planes, int channel) -> const auto& {
        return planes.features[static_cast<std::size_t>(channel)];
      });
}
template FeaturePairs<float, 1> PartnerRows::features(int y, Range columns) const;
template FeaturePairs<float, 3> PartnerRows::features(int y, Range columns) const;

kernels::CensusPairs PartnerRows::codes(int y, Range columns) const {
  return pairs<std::uint32_t, 2>(
      y, columns, channels(), [](const CostImage::Planes& planes, int channel) -> const auto& {
        return planes.codes[static_cast<std::size_t>(channel)];
      });
}

kernels::RayCensusPairs PartnerRows::ray_codes(int y, Range columns, int thresholds) const {
  return {
      pairs<std::uint8_t, kernels::kMostRayCensusBytes>(
          y, columns, channels(), [](const CostImage::Planes& planes, int channel) -> const auto& {
            return planes.ray_codes[static_cast<std::size_t>(channel)];
          },
          static_cast<std::size_t>(kernels::ray_census_bytes(thresholds))),
      thresholds};
}

kernels::CensusPairs PartnerRows::luma_codes(int y, Range columns) const {
  return pairs<std::uint32_t, 2>(
      y, columns, 1, [](const CostImage::Planes& planes, int /*channel*/) -> const auto& {
        return planes.codes[0];
      });
}

FeaturePairs<std::uint16_t, 3> PartnerRows::fixed_levels(int y, Range columns) const {
  return pairs<std::uint16_t, 3>(
      y, columns, channels(), [](const CostImage::Planes& planes, int channel) -> const auto& {
        return planes.fixed_levels[static_cast<std::size_t>(channel)];
      });
}

FeaturePairs<std::uint16_t, 2> PartnerRows::fixed_gradients(int y, Range columns) const {
  return pairs<std::uint16_t, 2>(
      y, columns, 1, [](const CostImage::Planes& planes, int /*channel*/) -> const auto& {
        return planes.fixed_gradients;
      });
}

FeaturePairs<float, 1> PartnerRows::grey_levels(int y, Range columns, float* work) const {
  FeaturePairs<float, 1> row = features<1>(y, columns);
  if (!is_interpolated()) {
    return row;
  }
  row.partner_step = row.lanes;
  for (int c = 0; c < row.channels; ++c) {
    const auto& of_partner =
        partner_.features[static_cast<std::size_t>(std::min(c, partner_.channels - 1))];
    kernels::interpolate_candidates(
        {geometry_.width, position(columns.begin), step(), columns.size(), row.lanes},
        shifts_.data(), partner_pixels(of_partner[0], y), work);
    row.channel[static_cast<std::size_t>(c)].partner[0] = work;
    work += static_cast<std::ptrdiff_t>(columns.size()) * row.lanes;
  }
  return row;
}

}  // namespace vantage
