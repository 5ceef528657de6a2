#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/forward_warp/forward_warp_simd.cc"
#include <hwy/foreach_target.h>
// After foreach_target.h, so that it is compiled once per target.
#include <hwy/highway.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernels/forward_warp/forward_warp.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Columns whose targets are computed at a time; a multiple of every vector's length.
constexpr int kBlock = 64;
// Farther than any row is wide, and safe to convert and to add to a column.
constexpr double kFarColumns = 1 << 29;

// floor(½ − s·d) for `count` disparities; 0 where unknown.
template <class D64>
HWY_INLINE void shifts_of(D64 d64, const float* disparity_px, int count, double camera_offset,
                          std::int32_t* HWY_RESTRICT shifts) {
  const hn::Rebind<float, D64> d32;
  const hn::Rebind<std::int32_t, D64> di32;
  const auto largest = hn::Set(d32, std::numeric_limits<float>::max());
  const auto offset = hn::Set(d64, camera_offset);
  const auto far = hn::Set(d64, kFarColumns);
  for (int i = 0; i < count; i += static_cast<int>(hn::Lanes(d64))) {
    const auto read = hn::LoadU(d32, disparity_px + i);
    const auto disparity = hn::IfThenElseZero(hn::Le(hn::Abs(read), largest), read);
    const auto exact = hn::Mul(offset, hn::PromoteTo(d64, disparity));
    const auto shift = hn::Floor(hn::Sub(hn::Set(d64, 0.5), exact));
    hn::StoreU(hn::DemoteTo(di32, hn::Min(hn::Max(shift, hn::Neg(far)), far)), di32, shifts + i);
  }
}

struct Sample {
  int column = 0;
  int target = 0;  // −1 and width stand for everything outside the view
  float disparity_px = std::numeric_limits<float>::quiet_NaN();
};

// Where a walk writes; kColumns: whether source columns are wanted.
template <bool kColumns>
struct Output {
  float* HWY_RESTRICT disparity_px;
  float* HWY_RESTRICT source_column;

  HWY_INLINE void write(int target, float disparity, float column) const {
    disparity_px[target] = disparity;
    if (kColumns) {
      source_column[target] = column;
    }
  }
};

template <bool kColumns>
HWY_NOINLINE void fill_sampling_gap(const ForwardWarpRow& row, Sample previous, Sample sample,
                                    Output<kColumns> output) {
  const double from = previous.column - row.camera_offset * previous.disparity_px;
  const double spacing = (sample.column - row.camera_offset * sample.disparity_px) - from;
  const double rise = double{sample.disparity_px} - previous.disparity_px;
  const int first = std::min(previous.target, sample.target) + 1;
  const int end = std::max(previous.target, sample.target);
  for (int n = first; n < end; ++n) {
    const double fraction = (n - from) / spacing;
    output.write(
        n, static_cast<float>(previous.disparity_px + fraction * rise),
        static_cast<float>(previous.column + fraction * (sample.column - previous.column)));
  }
}

// Walks one scanline; kStep is the direction.
template <int kStep, bool kColumns>
HWY_INLINE void walk(const ForwardWarpRow& row, Output<kColumns> output) {
  HWY_ALIGN std::int32_t shifts[kBlock];
  const hn::ScalableTag<double> d64;
  const hn::CappedTag<double, 1> d64_one;
  const int width = row.width;
  const float limit = row.gradient_limit_px;
  const int blocks = (width + kBlock - 1) / kBlock;
  Sample previous;
  for (int b = 0; b < blocks; ++b) {
    const int begin = (kStep > 0 ? b : blocks - 1 - b) * kBlock;
    const int count = std::min(kBlock, width - begin);
    const float* disparities = row.disparity_px + begin;
    const int whole_vectors = count - count % static_cast<int>(hn::Lanes(d64));
    shifts_of(d64, disparities, whole_vectors, row.camera_offset, shifts);
    shifts_of(d64_one, disparities + whole_vectors, count - whole_vectors, row.camera_offset,
              shifts + whole_vectors);
    for (int k = 0; k < count; ++k) {
      const int i = kStep > 0 ? k : count - 1 - k;
      Sample sample;
      if (std::abs(disparities[i]) <= std::numeric_limits<float>::max()) {
        sample.column = begin + i;
        sample.target = std::clamp(sample.column + shifts[i], -1, width);
        sample.disparity_px = disparities[i];
        if (HWY_UNLIKELY((sample.target - previous.target) * kStep > 1) &&
            std::abs(sample.disparity_px - previous.disparity_px) <= limit) {
          fill_sampling_gap(row, previous, sample, output);
        }
        if (HWY_LIKELY(sample.target >= 0 && sample.target < width)) {
          output.write(sample.target, sample.disparity_px, static_cast<float>(sample.column));
        }
      }
      previous = sample;
    }
  }
}

template <bool kColumns>
HWY_INLINE void walk_either_way(const ForwardWarpRow& row, Output<kColumns> output) {
  if (row.camera_offset >= 0) {
    walk<1>(row, output);
  } else {
    walk<-1>(row, output);
  }
}

void forward_warp(const ForwardWarpRow& row, float* warped_disparity_px, float* source_column) {
  constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();
  std::fill_n(warped_disparity_px, row.width, kUnknown);
  if (source_column == nullptr) {
    walk_either_way(row, Output<false>{warped_disparity_px, nullptr});
  } else {
    std::fill_n(source_column, row.width, kUnknown);
    walk_either_way(row, Output<true>{warped_disparity_px, source_column});
  }
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vantage::kernels {
HWY_EXPORT(forward_warp);

void forward_warp_row(const ForwardWarpRow& row, float* warped_disparity_px, float* source_column) {
  HWY_DYNAMIC_DISPATCH(forward_warp)(row, warped_disparity_px, source_column);
}

}  // namespace vantage::kernels
#endif
