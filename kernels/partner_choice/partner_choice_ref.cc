#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "kernels/cells/exp_log.h"
#include "kernels/partner_choice/partner_choice.h"

namespace vantage::kernels {
namespace {

constexpr float kMinLikelihood = std::numeric_limits<float>::min();

/// energy(cell): what is compared and averaged.
template <typename Energy>
float chosen(const PartnerCells& row, int column, int lane, const Energy& energy) {
  std::array<float, kMaxPartners> seen;
  int count = 0;
  float sum_all = 0;
  for (int p = 0; p < row.partners; ++p) {
    const float value = energy(row.cells[p * row.partner_stride + column * row.lanes + lane]);
    const CandidateRange range = row.seen[p * row.columns + column];
    sum_all += value;
    if (lane >= range.begin && lane < range.end) {
      seen[static_cast<std::size_t>(count++)] = value;
    }
  }
  const float scale = std::sqrt(static_cast<float>(row.partners));
  if (count == 0) {
    return sum_all / static_cast<float>(row.partners) * scale;
  }
  std::sort(seen.begin(), seen.begin() + count);
  const int half = std::min(count, (row.partners + 1) / 2);
  float sum = 0;
  for (int k = 0; k < half; ++k) {
    sum += seen[static_cast<std::size_t>(k)];
  }
  return sum / static_cast<float>(half) * scale;
}

}  // namespace

void choose_energies_row_ref(const PartnerCells& row, float* cells) {
  for (int j = 0; j < row.columns; ++j) {
    for (int i = 0; i < row.lanes; ++i) {
      cells[j * row.lanes + i] = chosen(row, j, i, [](float cell) { return cell; });
    }
  }
}

void choose_likelihoods_row_ref(const PartnerCells& row, float* cells) {
  for (int j = 0; j < row.columns; ++j) {
    for (int i = 0; i < row.lanes; ++i) {
      const float energy = chosen(
          row, j, i, [](float cell) { return -log_of_normal(std::max(cell, kMinLikelihood)); });
      cells[j * row.lanes + i] = i < row.count ? exp2_of_negative(energy * -kLog2E) : 0.0F;
    }
  }
}

}  // namespace vantage::kernels
