#include <cmath>

#include "kernels/column_ssd/column_ssd.h"

namespace vantage::kernels {
namespace {

int low_half(std::int32_t pair) { return static_cast<std::int16_t>(pair & 0xFFFF); }
int high_half(std::int32_t pair) { return static_cast<std::int16_t>(pair >> 16); }

std::int32_t rounded_square(const float* reference, const float* partner, int j, int k) {
  if (reference == nullptr) {
    return 0;
  }
  const float difference = reference[j] - partner[k];
  return static_cast<std::int32_t>(std::lrint(difference * difference));
}

// Modulo 2³²: the entering row may carry a sum past 2³¹ before the leaving one is subtracted.
std::int32_t changed(std::int32_t sum, std::int32_t enters, std::int32_t leaves) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(sum) +
                                   static_cast<std::uint32_t>(enters) -
                                   static_cast<std::uint32_t>(leaves));
}

}  // namespace

void column_ssd_row_ref(const ColumnSsdPairs& row, const std::int32_t* previous,
                        std::int32_t* sums) {
  for (int j = 0; j < row.columns; ++j) {
    for (int i = 0; i < row.lanes; ++i) {
      const int k = j * row.partner_step + i;
      const int entering = low_half(row.reference[j]) - low_half(row.partner[k]);
      const int leaving = high_half(row.reference[j]) - high_half(row.partner[k]);
      const int cell = j * row.lanes + i;
      sums[cell] = changed(previous[cell], entering * entering, leaving * leaving);
    }
  }
}

void column_ssd_row_ref(const ColumnSsdFloat& row, const std::int32_t* previous,
                        std::int32_t* sums) {
  for (int j = 0; j < row.columns; ++j) {
    for (int i = 0; i < row.lanes; ++i) {
      const int k = j * row.partner_step + i;
      const int cell = j * row.lanes + i;
      sums[cell] = changed(previous[cell],
                           rounded_square(row.reference_entering, row.partner_entering, j, k),
                           rounded_square(row.reference_leaving, row.partner_leaving, j, k));
    }
  }
}

}  // namespace vantage::kernels
