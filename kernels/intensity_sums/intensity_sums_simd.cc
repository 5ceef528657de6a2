#include "kernels/simd-inl.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "kernels/intensity_sums/intensity_sums.h"
#include "kernels/row_bits/row_bits.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {

// One channel per lane: each channel is summed from left to right, as in the reference.
constexpr int kChannels = 4;
using Doubles = hn::CappedTag<double, kChannels>;
using Vec = hn::VFromD<Doubles>;

// The sums of consecutive channels, one vector of them.
struct ChannelSums {
  Vec left, right, left_right, left_left;
};

HWY_INLINE void add_pixel(const float* left_colours, const float* right_colours,
                          ChannelSums& sums) {
  const Doubles d;
  const hn::Rebind<float, Doubles> d32;
  const auto left = hn::PromoteTo(d, hn::LoadU(d32, left_colours));
  const auto right = hn::PromoteTo(d, hn::LoadU(d32, right_colours));
  sums.left = hn::Add(sums.left, left);
  sums.right = hn::Add(sums.right, right);
  // Mul and Add, never MulAdd: results must not depend on the instruction set.
  sums.left_right = hn::Add(sums.left_right, hn::Mul(left, right));
  sums.left_left = hn::Add(sums.left_left, hn::Mul(left, left));
}

// Adds channels [first, first + lanes) of the row.
HWY_INLINE void sum_channels(const WarpedPairRow& row, const std::uint64_t* near, int begin,
                             int count, int first, ChannelSums& sums) {
  const float* left = row.left_colours + begin * kChannels + first;
  const float* right = row.right_colours + begin * kChannels + first;
  for (int word = 0; word < row_words(count); ++word) {
    const std::uint64_t bits = near[word];
    const int x = 64 * word;
    if (bits == ~std::uint64_t{0}) {
      for (int i = x; i < x + 64; ++i) {
        add_pixel(left + i * kChannels, right + i * kChannels, sums);
      }
      continue;
    }
    for (std::uint64_t rest = bits; rest != 0; rest &= rest - 1) {
      const int i = x + std::countr_zero(rest);
      add_pixel(left + i * kChannels, right + i * kChannels, sums);
    }
  }
}

IntensitySums sums_of_row(const WarpedPairRow& row) {
  if (row.lanes == 1) {
    return intensity_sums_row_ref(row);
  }
  constexpr int kBlock = 1024;
  const Doubles d;
  constexpr int kLanes = static_cast<int>(hn::MaxLanes(d));
  std::uint64_t near[row_words(kBlock)];
  IntensitySums total;
  for (int begin = 0; begin < row.width; begin += kBlock) {
    const int count = std::min(kBlock, row.width - begin);
    near_bits_row(row.left_disparity_px + begin, row.right_disparity_px + begin,
                  row.gradient_limit_px, count, near);
    for (int word = 0; word < row_words(count); ++word) {
      total.pixels += std::popcount(near[word]);
    }
    for (int first = 0; first < kChannels; first += kLanes) {
      ChannelSums sums{hn::LoadU(d, total.left + first), hn::LoadU(d, total.right + first),
                       hn::LoadU(d, total.left_right + first),
                       hn::LoadU(d, total.left_left + first)};
      sum_channels(row, near, begin, count, first, sums);
      hn::StoreU(sums.left, d, total.left + first);
      hn::StoreU(sums.right, d, total.right + first);
      hn::StoreU(sums.left_right, d, total.left_right + first);
      hn::StoreU(sums.left_left, d, total.left_left + first);
    }
  }
  return total;
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vantage::kernels {
HWY_EXPORT(sums_of_row);

IntensitySums intensity_sums_row(const WarpedPairRow& row) {
  return HWY_DYNAMIC_DISPATCH(sums_of_row)(row);
}

// Scalar reference.

namespace {

template <int kLanes>
IntensitySums sums_of(const WarpedPairRow& row) {
  IntensitySums sums;
  for (int x = 0; x < row.width; ++x) {
    // False if either is NaN.
    if (std::abs(row.left_disparity_px[x] - row.right_disparity_px[x]) <= row.gradient_limit_px) {
      ++sums.pixels;
      for (int c = 0; c < kLanes; ++c) {
        const double left = row.left_colours[x * kLanes + c];
        const double right = row.right_colours[x * kLanes + c];
        sums.left[c] += left;
        sums.right[c] += right;
        sums.left_right[c] += left * right;
        sums.left_left[c] += left * left;
      }
    }
  }
  return sums;
}

}  // namespace

void IntensitySums::add(const IntensitySums& other) {
  pixels += other.pixels;
  for (int c = 0; c < 4; ++c) {
    left[c] += other.left[c];
    right[c] += other.right[c];
    left_right[c] += other.left_right[c];
    left_left[c] += other.left_left[c];
  }
}

IntensitySums intensity_sums_row_ref(const WarpedPairRow& row) {
  return row.lanes == 1 ? sums_of<1>(row) : sums_of<4>(row);
}

}  // namespace vantage::kernels
#endif
