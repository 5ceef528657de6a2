// Sums over the sixteen taps of bicubic interpolation, read from pixels of any type. Included once
// per target by dispatched files.

#if defined(VANTAGE_KERNELS_BICUBIC_TAPS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VANTAGE_KERNELS_BICUBIC_TAPS_INL_H_
#undef VANTAGE_KERNELS_BICUBIC_TAPS_INL_H_
#else
#define VANTAGE_KERNELS_BICUBIC_TAPS_INL_H_
#endif

#include <cstddef>
#include <type_traits>

#include "kernels/keys_weights-inl.h"
#include "kernels/pixel_row/load_as_float-inl.h"
#include "kernels/pixel_row/pixel_row.h"
#include "kernels/simd-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {

// New pixels processed at a time, step by step; a multiple of every vector length.
constexpr int kTapBlock = 64;
// Four taps of four channels.
constexpr int kTapLanes = 16;
// Values that sum_down() loads per line, starting at the first tap. Whole vectors, so sometimes
// more than the taps.
template <int kChannels>
constexpr int kTapsLoaded = kChannels == 1 ? 4 : kTapLanes;
// Pixels that sum_down() reads after the last tap.
template <int kChannels>
constexpr int kPixelsReadBehind =
    (kTapsLoaded<kChannels> - 4 * kChannels + kChannels - 1) / kChannels;

// Intermediate results between the steps. All of it stays in the level 1 cache.
struct TapSums {
  float weight_x[4][kTapBlock];
  float weight_y[4 * kTapBlock];  // a pixel's four weights are adjacent
  float
      sum_down[kTapLanes * kTapBlock];  // [i · taps + tap · channels + c], sums over the four lines
  float min_down[kTapLanes * kTapBlock];  // floats only
  float max_down[kTapLanes * kTapBlock];
};

// Weights of new pixels i, i + 1, … from the fractions of their positions.
template <class D, class V = hn::VFromD<D>>
HWY_INLINE void store_weights(D d, V fraction_x, V fraction_y, int i, TapSums& sums) {
  const auto weight_x = keys_weights(d, fraction_x);
  for (int tap = 0; tap < 4; ++tap) {
    hn::StoreU(weight_x.at[tap], d, sums.weight_x[tap] + i);
  }
  const auto weight_y = keys_weights(d, fraction_y);
  hn::StoreInterleaved4(weight_y.at[0], weight_y.at[1], weight_y.at[2], weight_y.at[3], d,
                        sums.weight_y + 4 * i);
}

// Sums over the four lines for each of the four taps of pixel i; `tap` is the first tap.
template <int kChannels, typename T>
HWY_INLINE void sum_down(const T* HWY_RESTRICT tap, std::ptrdiff_t stride, int i, TapSums& sums) {
  constexpr int kTaps = kTapsLoaded<kChannels>;  // three channels use 12 of them
  const hn::CappedTag<float, kTaps> d;
  const float* weight = sums.weight_y + 4 * i;
  const auto weight0 = hn::Set(d, weight[0]);
  const auto weight1 = hn::Set(d, weight[1]);
  const auto weight2 = hn::Set(d, weight[2]);
  const auto weight3 = hn::Set(d, weight[3]);
  for (int lane = 0; lane < 4 * kChannels; lane += static_cast<int>(hn::Lanes(d))) {
    const auto line0 = load_as_float(d, tap + lane);
    const auto line1 = load_as_float(d, tap + stride + lane);
    const auto line2 = load_as_float(d, tap + 2 * stride + lane);
    const auto line3 = load_as_float(d, tap + 3 * stride + lane);
    // Mul and Add, never fused: results must not depend on the instruction set.
    hn::StoreU(hn::Add(hn::Add(hn::Mul(weight0, line0), hn::Mul(weight1, line1)),
                       hn::Add(hn::Mul(weight2, line2), hn::Mul(weight3, line3))),
               d, sums.sum_down + kTaps * i + lane);
    if constexpr (std::is_same_v<T, float>) {
      hn::StoreU(hn::Min(hn::Min(line0, line1), hn::Min(line2, line3)), d,
                 sums.min_down + kTaps * i + lane);
      hn::StoreU(hn::Max(hn::Max(line0, line1), hn::Max(line2, line3)), d,
                 sums.max_down + kTaps * i + lane);
    }
  }
}

template <typename T, class D, class V = hn::VFromD<D>>
HWY_INLINE V limited(D d, V sum, V min, V max) {
  const auto smallest = hn::Min(hn::Zero(d), min);
  const auto largest = hn::Max(hn::Set(d, kLargestValue<T>), max);
  return hn::Min(hn::Max(sum, smallest), largest);
}

// Values of grey pixels i, i + 1, …: sums over their four taps.
template <typename T, class D>
HWY_INLINE hn::VFromD<D> sum_along_grey(D d, const TapSums& sums, int i) {
  hn::VFromD<D> tap0;
  hn::VFromD<D> tap1;
  hn::VFromD<D> tap2;
  hn::VFromD<D> tap3;
  hn::LoadInterleaved4(d, sums.sum_down + 4 * i, tap0, tap1, tap2, tap3);
  const auto sum = hn::Add(hn::Add(hn::Mul(hn::LoadU(d, sums.weight_x[0] + i), tap0),
                                   hn::Mul(hn::LoadU(d, sums.weight_x[1] + i), tap1)),
                           hn::Add(hn::Mul(hn::LoadU(d, sums.weight_x[2] + i), tap2),
                                   hn::Mul(hn::LoadU(d, sums.weight_x[3] + i), tap3)));
  auto min = hn::Zero(d);
  auto max = min;
  if constexpr (std::is_same_v<T, float>) {
    hn::LoadInterleaved4(d, sums.min_down + 4 * i, tap0, tap1, tap2, tap3);
    min = hn::Min(hn::Min(tap0, tap1), hn::Min(tap2, tap3));
    hn::LoadInterleaved4(d, sums.max_down + 4 * i, tap0, tap1, tap2, tap3);
    max = hn::Max(hn::Max(tap0, tap1), hn::Max(tap2, tap3));
  }
  return limited<T>(d, sum, min, max);
}

// Colour pixel i, one vector. With three channels the fourth lane is meaningless.
template <int kChannels, typename T>
HWY_INLINE hn::VFromD<hn::FixedTag<float, 4>> sum_along_colour(const TapSums& sums, int i) {
  const hn::FixedTag<float, 4> d;
  const auto tap = [&](const float* down, int k)
                       HWY_ATTR { return hn::LoadU(d, down + kTapLanes * i + k * kChannels); };
  const auto weighted = [&](int k) HWY_ATTR {
    return hn::Mul(hn::Set(d, sums.weight_x[k][i]), tap(sums.sum_down, k));
  };
  const auto sum = hn::Add(hn::Add(weighted(0), weighted(1)), hn::Add(weighted(2), weighted(3)));
  auto min = hn::Zero(d);
  auto max = min;
  if constexpr (std::is_same_v<T, float>) {
    const float* down = sums.min_down;
    min = hn::Min(hn::Min(tap(down, 0), tap(down, 1)), hn::Min(tap(down, 2), tap(down, 3)));
    down = sums.max_down;
    max = hn::Max(hn::Max(tap(down, 0), tap(down, 1)), hn::Max(tap(down, 2), tap(down, 3)));
  }
  return limited<T>(d, sum, min, max);
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // VANTAGE_KERNELS_BICUBIC_TAPS_INL_H_
