#include "kernels/simd-inl.h"

#include <algorithm>
#include <limits>

#include "kernels/rgb_row/rgb_row.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {

// Pixels buffered between the float computation and the interleaving of full result vectors; whole
// vectors of both.
constexpr int kBlock = 64;

template <typename T>
HWY_INLINE void convert(const LumaChromaRow& row, const ColourFactors& factors,
                        T* HWY_RESTRICT rgb) {
  const hn::CappedTag<float, kBlock> d;
  const hn::RebindToSigned<decltype(d)> d32;
  const hn::Rebind<std::uint16_t, decltype(d)> d16;
  const hn::Rebind<T, decltype(d)> d_part;
  const hn::CappedTag<T, kBlock> d_full;
  const int part = static_cast<int>(hn::Lanes(d));
  const int full = static_cast<int>(hn::Lanes(d_full));
  const auto neutral = hn::Set(d, 128.0F * 256.0F);
  const auto black = hn::Set(d, factors.black);
  const auto grey_factor = hn::Set(d, factors.grey);
  const auto red_of_red = hn::Set(d, factors.red_of_red);
  const auto green_of_red = hn::Set(d, factors.green_of_red);
  const auto green_of_blue = hn::Set(d, factors.green_of_blue);
  const auto blue_of_blue = hn::Set(d, factors.blue_of_blue);
  const auto zero = hn::Zero(d);
  const auto half = hn::Set(d, 0.5F);
  const auto white = hn::Set(d, static_cast<float>(std::numeric_limits<T>::max()));
  const auto load = [&](const std::uint16_t* samples) HWY_ATTR {
    return hn::ConvertTo(d, hn::PromoteTo(d32, hn::LoadU(d16, samples)));
  };
  const auto store = [&](hn::VFromD<decltype(d)> level, T* channel) HWY_ATTR {
    const auto rounded = hn::ConvertTo(d32, hn::Add(hn::Min(hn::Max(level, zero), white), half));
    hn::StoreU(hn::DemoteTo(d_part, rounded), d_part, channel);
  };
  HWY_ALIGN T reds[kBlock];
  HWY_ALIGN T greens[kBlock];
  HWY_ALIGN T blues[kBlock];
  int x = 0;
  for (; x + kBlock <= row.width; x += kBlock) {
    for (int i = 0; i < kBlock; i += part) {
      // Mul and Add, never MulAdd: results must not depend on the instruction set.
      const auto grey = hn::Mul(hn::Sub(load(row.luma + x + i), black), grey_factor);
      const auto blue = hn::Sub(load(row.chroma_blue + x + i), neutral);
      const auto red = hn::Sub(load(row.chroma_red + x + i), neutral);
      store(hn::Add(grey, hn::Mul(red_of_red, red)), reds + i);
      store(hn::Sub(hn::Sub(grey, hn::Mul(green_of_red, red)), hn::Mul(green_of_blue, blue)),
            greens + i);
      store(hn::Add(grey, hn::Mul(blue_of_blue, blue)), blues + i);
    }
    for (int i = 0; i < kBlock; i += full) {
      hn::StoreInterleaved3(hn::Load(d_full, reds + i), hn::Load(d_full, greens + i),
                            hn::Load(d_full, blues + i), d_full, rgb + 3 * (x + i));
    }
  }
  rgb_row_ref({row.luma + x, row.chroma_blue + x, row.chroma_red + x, row.width - x}, factors,
              rgb + 3 * x);
}

void rgb_row_8(const LumaChromaRow& row, const ColourFactors& factors, std::uint8_t* rgb) {
  convert(row, factors, rgb);
}

void rgb_row_16(const LumaChromaRow& row, const ColourFactors& factors, std::uint16_t* rgb) {
  convert(row, factors, rgb);
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vantage::kernels {
HWY_EXPORT(rgb_row_8);
HWY_EXPORT(rgb_row_16);

void rgb_row(const LumaChromaRow& row, const ColourFactors& factors, std::uint8_t* rgb) {
  HWY_DYNAMIC_DISPATCH(rgb_row_8)(row, factors, rgb);
}

void rgb_row(const LumaChromaRow& row, const ColourFactors& factors, std::uint16_t* rgb) {
  HWY_DYNAMIC_DISPATCH(rgb_row_16)(row, factors, rgb);
}

// Scalar reference.

namespace {

constexpr float kNeutral = 128 * 256;

template <typename T>
T stored(float level) {
  constexpr float kWhite = std::numeric_limits<T>::max();
  return static_cast<T>(static_cast<int>(std::min(std::max(level, 0.0F), kWhite) + 0.5F));
}

template <typename T>
void convert(const LumaChromaRow& row, const ColourFactors& factors, T* rgb) {
  for (int x = 0; x < row.width; ++x) {
    const float grey = (static_cast<float>(row.luma[x]) - factors.black) * factors.grey;
    const float blue = static_cast<float>(row.chroma_blue[x]) - kNeutral;
    const float red = static_cast<float>(row.chroma_red[x]) - kNeutral;
    rgb[3 * x] = stored<T>(grey + factors.red_of_red * red);
    rgb[3 * x + 1] = stored<T>(grey - factors.green_of_red * red - factors.green_of_blue * blue);
    rgb[3 * x + 2] = stored<T>(grey + factors.blue_of_blue * blue);
  }
}

}  // namespace

void rgb_row_ref(const LumaChromaRow& row, const ColourFactors& factors, std::uint8_t* rgb) {
  convert(row, factors, rgb);
}

void rgb_row_ref(const LumaChromaRow& row, const ColourFactors& factors, std::uint16_t* rgb) {
  convert(row, factors, rgb);
}

}  // namespace vantage::kernels
#endif
