#include "kernels/simd-inl.h"

#include <algorithm>
#include <cstddef>

#include "kernels/luma_intensity/luma_intensity.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {

void luma_intensity(const std::uint8_t* HWY_RESTRICT pixels, int width, int channels,
                    std::uint8_t* HWY_RESTRICT intensities) {
  if (channels == 1) {
    std::copy_n(pixels, width, intensities);
    return;
  }
  const hn::ScalableTag<std::uint16_t> d16;
  const hn::Rebind<std::uint8_t, decltype(d16)> d8;
  const int step = static_cast<int>(hn::Lanes(d16));
  int x = 0;
  for (; x + step <= width; x += step) {
    const std::uint8_t* at = pixels + static_cast<std::ptrdiff_t>(x) * channels;
    auto red = hn::Undefined(d8);
    auto green = hn::Undefined(d8);
    auto blue = hn::Undefined(d8);
    if (channels == 3) {
      hn::LoadInterleaved3(d8, at, red, green, blue);
    } else {
      auto alpha = hn::Undefined(d8);
      hn::LoadInterleaved4(d8, at, red, green, blue, alpha);
    }
    // At most 255 · 256 + 128.
    const auto weighted = [&](auto channel, std::uint16_t weight) HWY_ATTR {
      return hn::Mul(hn::PromoteTo(d16, channel), hn::Set(d16, weight));
    };
    const auto sum = hn::Add(hn::Add(weighted(red, 77), weighted(green, 150)),
                             hn::Add(weighted(blue, 29), hn::Set(d16, 128)));
    const hn::RebindToSigned<decltype(d16)> di16;
    hn::StoreU(hn::DemoteTo(d8, hn::BitCast(di16, hn::ShiftRight<8>(sum))), d8, intensities + x);
  }
  luma_intensity_row_ref(pixels + static_cast<std::ptrdiff_t>(x) * channels, width - x, channels,
                         intensities + x);
}

void luma(const std::uint8_t* HWY_RESTRICT pixels, int width, int channels,
          float* HWY_RESTRICT output) {
  const hn::CappedTag<std::uint8_t, 16> d8;
  const hn::CappedTag<float, 16> df;
  const hn::Rebind<std::int32_t, decltype(df)> d32;
  const hn::Rebind<std::uint8_t, decltype(df)> part8;
  const auto step = static_cast<int>(hn::Lanes(d8));
  const auto part = static_cast<int>(hn::Lanes(df));
  HWY_ALIGN std::uint8_t of_channel[3][16];
  int x = 0;
  for (; x + step <= width; x += step) {
    const std::uint8_t* at = pixels + static_cast<std::ptrdiff_t>(x) * channels;
    auto red = hn::Undefined(d8);
    auto green = hn::Undefined(d8);
    auto blue = hn::Undefined(d8);
    if (channels == 3) {
      hn::LoadInterleaved3(d8, at, red, green, blue);
    } else {
      auto alpha = hn::Undefined(d8);
      hn::LoadInterleaved4(d8, at, red, green, blue, alpha);
    }
    hn::Store(red, d8, of_channel[0]);
    hn::Store(green, d8, of_channel[1]);
    hn::Store(blue, d8, of_channel[2]);
    for (int k = 0; k < step; k += part) {
      const auto weighted = [&](const std::uint8_t* bytes, float weight) HWY_ATTR {
        const auto whole = hn::PromoteTo(d32, hn::Load(part8, bytes + k));
        return hn::Mul(hn::ConvertTo(df, whole), hn::Set(df, weight));
      };
      const auto sum =
          hn::Add(hn::Add(weighted(of_channel[0], kLumaRed), weighted(of_channel[1], kLumaGreen)),
                  weighted(of_channel[2], kLumaBlue));
      hn::StoreU(sum, df, output + x + k);
    }
  }
  luma_row_ref(pixels + static_cast<std::ptrdiff_t>(x) * channels, width - x, channels, output + x);
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vantage::kernels {
HWY_EXPORT(luma_intensity);
HWY_EXPORT(luma);

void luma_intensity_row(const std::uint8_t* pixels, int width, int channels,
                        std::uint8_t* intensities) {
  HWY_DYNAMIC_DISPATCH(luma_intensity)(pixels, width, channels, intensities);
}
void luma_row(const std::uint8_t* pixels, int width, int channels, float* output) {
  HWY_DYNAMIC_DISPATCH(luma)(pixels, width, channels, output);
}

// Scalar reference.

void luma_intensity_row_ref(const std::uint8_t* pixels, int width, int channels,
                            std::uint8_t* intensities) {
  for (int x = 0; x < width; ++x, pixels += channels) {
    intensities[x] = channels == 1
                         ? pixels[0]
                         : static_cast<std::uint8_t>(
                               (77 * pixels[0] + 150 * pixels[1] + 29 * pixels[2] + 128) / 256);
  }
}

void luma_row_ref(const std::uint8_t* pixels, int width, int channels, float* luma) {
  for (int x = 0; x < width; ++x, pixels += channels) {
    luma[x] = kLumaRed * static_cast<float>(pixels[0]) +
              kLumaGreen * static_cast<float>(pixels[1]) +
              kLumaBlue * static_cast<float>(pixels[2]);
  }
}

}  // namespace vantage::kernels
#endif
