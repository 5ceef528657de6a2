#include "kernels/simd-inl.h"

#include <algorithm>
#include <limits>

#include "kernels/colour_fetch/bicubic_colours-inl.h"
#include "kernels/colour_fetch/colour_fetch.h"
#include "kernels/pixel_row/pixel_row.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {

template <int kChannels, bool kInRange>
HWY_INLINE void fetch(const BicubicFetchRow& row, int n, Vec disparity_px,
                      float* HWY_RESTRICT colours) {
  const Values d;
  Vec colour[kChannels];
  fetch_colours<kChannels, kInRange>(row, n, disparity_px, colour);
  if constexpr (kChannels == 1) {
    hn::StoreU(colour[0], d, colours);
  } else if constexpr (kChannels == 3) {
    hn::StoreInterleaved4(colour[0], colour[1], colour[2], hn::Zero(d), d, colours);
  } else {
    hn::StoreInterleaved4(colour[0], colour[1], colour[2], colour[3], d, colours);
  }
}

template <int kChannels, bool kInRange>
HWY_INLINE void fetch_all(const BicubicFetchRow& given, float* HWY_RESTRICT colours) {
  const BicubicFetchRow row = given;  // a copy: stores to colours cannot alias it
  const Values d;
  constexpr int kLanes = pixel_lanes(kChannels);
  int n = 0;
  for (; n + kAtOnce <= row.width; n += kAtOnce) {
    fetch<kChannels, kInRange>(row, n, hn::LoadU(d, row.warped_disparity_px + n),
                               colours + n * kLanes);
  }
  if (n < row.width) {
    // The positions after the end are holes.
    HWY_ALIGN float disparity_px[kAtOnce];
    HWY_ALIGN float last_colours[kAtOnce * kLanes];
    std::fill_n(disparity_px, kAtOnce, std::numeric_limits<float>::quiet_NaN());
    std::copy(row.warped_disparity_px + n, row.warped_disparity_px + row.width, disparity_px);
    fetch<kChannels, kInRange>(row, n, hn::Load(d, disparity_px), last_colours);
    std::copy_n(last_colours, (row.width - n) * kLanes, colours + n * kLanes);
  }
}

template <int kChannels>
HWY_INLINE void fetch_channels(const BicubicFetchRow& row, float* colours) {
  row.is_in_range ? fetch_all<kChannels, true>(row, colours)
                  : fetch_all<kChannels, false>(row, colours);
}

void fetch_bicubic(const BicubicFetchRow& row, float* colours) {
  if (row.channels == 1) {
    fetch_channels<1>(row, colours);
  } else if (row.channels == 3) {
    fetch_channels<3>(row, colours);
  } else {
    fetch_channels<4>(row, colours);
  }
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vantage::kernels {
HWY_EXPORT(fetch_bicubic);

void fetch_bicubic_row(const BicubicFetchRow& row, float* colours) {
  HWY_DYNAMIC_DISPATCH(fetch_bicubic)(row, colours);
}

}  // namespace vantage::kernels
#endif
