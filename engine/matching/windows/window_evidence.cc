#include "engine/matching/windows/window_evidence.h"

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "engine/matching/costs/ray_census_planes.h"
#include "kernels/disparity_prior/disparity_prior.h"
#include "kernels/window_evidence/window_evidence.h"

namespace vantage {

using kernels::kWindowCandidates;
using kernels::kWindows;
using kernels::WindowCells;
using scheduler::Range;

const WindowEvidence::Codes& WindowEvidence::codes_of(const CostImage& image) {
  return static_cast<const RayCensusPlanes&>(image.planes()).codes[0];
}

WindowEvidence::WindowEvidence(const WindowLevelInput& input, const WindowFormat& format,
                               int columns, WindowCells lanes)
    : input_(input),
      format_(format),
      reference_(codes_of(input.reference)),
      partner_(codes_of(input.partner)),
      lanes_(lanes) {
  const kernels::CandidateRange with_all = input.geometry.columns_with_all_partners();
  inner_ = {std::clamp((with_all.begin + input.side - 1) / input.side, 0, columns),
            std::clamp(with_all.end / input.side, 0, columns)};
  partnered_.reserve(static_cast<std::size_t>(columns));
  for (int x = 0; x < columns; ++x) {
    const int first = input.side * x;
    partnered_.push_back(input.geometry.with_partners(
        first, std::min(first + input.side, input.geometry.width) - 1));
  }
}

void WindowEvidence::make_row(int y, Range columns, const WindowStartRow& starts,
                              WindowCellsRow& evidence) const {
  const int side = input_.side;
  kernels::WindowEvidenceRow row;
  row.side = side;
  row.thresholds = input_.parameters.census_thresholds;
  for (std::size_t q = 0; q < kWindows; ++q) {
    row.start[q] = starts.start[q].data() + columns.begin;
  }
  row.has_second = starts.has_second.data() + columns.begin;
  row.columns = columns.size();
  row.direction = input_.geometry.direction;
  const int first_pixel = side * columns.begin;
  const std::ptrdiff_t first_partner = input_.geometry.partner(first_pixel, 0);
  const auto bytes = static_cast<std::size_t>(kernels::ray_census_bytes(row.thresholds));
  for (int r = 0; r < side; ++r) {
    const int of_image = std::min(side * y + r, input_.reference.height() - 1);
    const auto at = static_cast<std::size_t>(r);
    for (std::size_t p = 0; p < bytes; ++p) {
      row.reference[at][p] = reference_[p].plain.row(of_image) + first_pixel;
      row.partner[at][p] = partner_[p].plain.row(of_image) + first_partner;
    }
  }
  const auto cells = evidence.data();
  kernels::window_evidence_row(row, format_.evidence(),
                               {cells[0] + columns.begin, cells[1] + columns.begin});
  if (!input_.prior_px.empty()) {
    add_prior(y, columns, starts, cells);
  }
  if (lanes_ != ~WindowCells{0}) {
    for (WindowCells* const of_window : cells) {
      for (int x = columns.begin; x < columns.end; ++x) {
        of_window[x] &= lanes_;
      }
    }
  }
  for_each_outer_column(columns, [&](int x) {
    cells[0][x] &= with_partner(x, starts.start[0].data()[x]);
    if (starts.has_second.data()[x] != 0) {
      cells[1][x] &= with_partner(x, starts.start[1].data()[x]);
    }
  });
}

void WindowEvidence::add_prior(int y, Range columns, const WindowStartRow& starts,
                               const std::array<WindowCells*, kWindows>& evidence) const {
  const int side = input_.side;
  const double steps = input_.prior_weight * kernels::kPriorDepth / format_.nats_per_step();
  const auto add_pixel = [&](float prior_px, int x) {
    const float offset = prior_px - static_cast<float>(input_.geometry.disparity_min);
    if (!(offset >= 0 && offset <= static_cast<float>(input_.geometry.count - 1))) {
      return;
    }
    for (std::size_t q = 0; q < kWindows; ++q) {
      if (q == 1 && starts.has_second.data()[x] == 0) {
        continue;
      }
      WindowCells& cells = evidence[q][x];
      const int start = starts.start[q].data()[x];
      for (int k = 0; k < kWindowCandidates; ++k) {
        const double distance = (static_cast<float>(start + k) - offset) / kernels::kPriorReachPx;
        if (std::abs(distance) < 1) {
          const int sum = kernels::window_cell(cells, k) +
                          static_cast<int>(std::lround(steps * (1 - distance * distance)));
          cells &= ~(WindowCells{255} << (8 * k));
          cells |= static_cast<WindowCells>(std::min(sum, 255)) << (8 * k);
        }
      }
    }
  };
  for (int r = 0; r < side; ++r) {
    const float* const of_row =
        input_.prior_px.row(std::min(side * y + r, input_.prior_px.height() - 1));
    for (int x = columns.begin; x < columns.end; ++x) {
      for (int i = 0; i < side; ++i) {
        add_pixel(of_row[std::min(side * x + i, input_.prior_px.width() - 1)], x);
      }
    }
  }
}

}  // namespace vantage
