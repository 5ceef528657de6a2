#include "engine/matching/costs/partner_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/error.h"
#include "engine/rectification/epipolar_grid.h"

namespace vantage {

namespace {

/// Products of ratios that differ by less from whole numbers are these.
constexpr double kRounding = 1e-9;

}  // namespace

using kernels::CandidateRange;

int sample_phases(double baseline_ratio, int steps_per_px) {
  for (int phases = 1; phases < kMaxSamplePhases; ++phases) {
    const double samples = std::abs(baseline_ratio) * phases / steps_per_px;
    if (std::abs(samples - std::round(samples)) < kRounding) {
      return phases;
    }
  }
  return kMaxSamplePhases;
}

PartnerRows::PartnerRows(const CostImage& reference, const CostPartner& partner,
                         const kernels::CandidateGeometry& geometry)
    : reference_(reference),
      partner_(*partner.image),
      epipolar_(partner.epipolar),
      geometry_(geometry),
      rows_down_(geometry.direction * partner.disparity_y_px) {
  geometry_.near_ratio = 1;
  geometry_.opposite_ratio = 0;
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
  const int phases = partner_.phases();
  if (epipolar_ == nullptr &&
      std::abs(std::abs(ratio) * phases / geometry.steps_per_px - 1) < kRounding) {
    geometry_.steps_per_px = phases;
    return;
  }
  for (int lane = 0; lane < geometry.lanes(); ++lane) {
    const double shift_px =
        (geometry.disparity_min + lane) * std::abs(ratio) / geometry.steps_per_px;
    // Halves go up, so that offsets ascend whatever the sign.
    offsets_.push_back(static_cast<int>(std::floor(shift_px * phases + 0.5)));
  }
}

std::size_t PartnerRows::gather_bytes(int columns) const {
  return is_gathered() ? kMaxFeatureBytes * static_cast<std::size_t>(columns) * offsets_.size() : 0;
}

int PartnerRows::channels() const { return std::max(reference_.channels(), partner_.channels()); }

bool PartnerRows::has_row(int y) const {
  return epipolar_ != nullptr || partner_row(y) == y + rows_down_;
}

PartnerRows::LineSample PartnerRows::line_sample(int x, int y) const {
  const EpipolarGrid::Place& place = epipolar_->place(x, y);
  return {.phase = place.line % EpipolarGrid::kPhases,
          .row = place.line / EpipolarGrid::kPhases,
          .sample = mirrored() ? last_sample() - place.sample : place.sample};
}

int PartnerRows::partner_row(int y) const {
  return std::clamp(y + rows_down_, 0, partner_.height() - 1);
}

int PartnerRows::sample(int x) const {
  return partner_.phases() * (mirrored() ? geometry_.width - 1 - x : x);
}

CandidateRange PartnerRows::with_partner(int x, int y) const {
  if (epipolar_ != nullptr) {
    const EpipolarGrid::Place& place = epipolar_->place(x, y);
    const scheduler::Range seen = epipolar_->seen_samples(place.line);
    if (!place.has_line || seen.size() <= 0) {
      return {};
    }
    // As if the line began and ended with what is seen.
    const int to_end = seen.end - 1 - place.sample;
    const int from_begin = place.sample - seen.begin;
    return kernels::candidates_inside(offsets_.data(), geometry_.count, seen.size() - 1,
                                      mirrored() ? to_end : from_begin);
  }
  if (!is_gathered()) {
    return geometry_.with_partner(x);
  }
  return kernels::candidates_inside(offsets_.data(), geometry_.count, last_sample(), sample(x));
}

CandidateRange PartnerRows::columns_with_all_partners() const {
  return is_gathered() ? CandidateRange{} : geometry_.columns_with_all_partners();
}

}  // namespace vantage
