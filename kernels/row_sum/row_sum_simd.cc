#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/row_sum/row_sum_simd.cc"
#include <hwy/foreach_target.h>
// After foreach_target.h, so that it is compiled once per target.
#include <hwy/highway.h>

#include <algorithm>
#include <cstddef>

#include "kernels/row_sum/row_sum.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Tag32 = hn::ScalableTag<std::int32_t>;
using Vec32 = hn::VFromD<Tag32>;

// kVectors vectors of neighbouring lanes over all columns: the running sums stay in registers from
// column to column, and a column's lanes are touched in whole cache lines.
template <int kVectors>
HWY_INLINE void sum_lanes(const RowSum& row, int first_lane) {
  const Tag32 d32;
  const int step = static_cast<int>(hn::Lanes(d32));
  const std::ptrdiff_t lanes = row.lanes;
  const std::int32_t* const input = row.input + first_lane;
  std::int32_t* output = row.output + first_lane;
  const int input_begin = row.input_begin;
  const int radius = row.radius;

  Vec32 sum[kVectors];
  for (int v = 0; v < kVectors; ++v) {
    sum[v] = row.number_lanes ? hn::Iota(d32, first_lane + v * step) : hn::Zero(d32);
  }
  const auto enter = [&](int column) HWY_ATTR {
    const std::int32_t* cell = input + (column - input_begin) * lanes;
    for (int v = 0; v < kVectors; ++v) {
      sum[v] = hn::Add(sum[v], hn::LoadU(d32, cell + v * step));
    }
  };
  const auto leave = [&](int column) HWY_ATTR {
    const std::int32_t* cell = input + (column - input_begin) * lanes;
    for (int v = 0; v < kVectors; ++v) {
      sum[v] = hn::Sub(sum[v], hn::LoadU(d32, cell + v * step));
    }
  };
  const auto store = [&]() HWY_ATTR {
    for (int v = 0; v < kVectors; ++v) {
      hn::StoreU(sum[v], d32, output + v * step);
    }
    output += lanes;
  };

  for (int column = input_begin; column < std::min(row.output_begin + radius, row.input_end);
       ++column) {
    enter(column);
  }
  // Four stretches without a branch in them: growing windows at the left border of the image (in a
  // strip inside it: its first column), windows wider than the image, full windows, and shrinking
  // ones at the right border.
  const int leave_from = std::min(input_begin + radius + 1, row.output_end);
  const int enter_until = std::min(row.input_end - radius, row.output_end);
  int x = row.output_begin;
  for (; x < std::min(leave_from, enter_until); ++x) {
    enter(x + radius);
    store();
  }
  for (; x < leave_from; ++x) {
    store();
  }
  for (; x < enter_until; ++x) {
    enter(x + radius);
    leave(x - radius - 1);
    store();
  }
  for (; x < row.output_end; ++x) {
    leave(x - radius - 1);
    store();
  }
}

void row_sum_simd(const RowSum& row) {
  const int step = static_cast<int>(hn::Lanes(Tag32()));
  int lane = 0;
  for (; lane + 4 * step <= row.lanes; lane += 4 * step) {
    sum_lanes<4>(row, lane);
  }
  for (; lane < row.lanes; lane += step) {
    sum_lanes<1>(row, lane);
  }
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vantage::kernels {
HWY_EXPORT(row_sum_simd);

void row_sum(const RowSum& row) { HWY_DYNAMIC_DISPATCH(row_sum_simd)(row); }

}  // namespace vantage::kernels
#endif
