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
  const hn::CappedTag<std::uint16_t, kBlock> d16;
  const hn::RepartitionToWide<decltype(d16)> d32;
  const hn::RebindToSigned<decltype(d32)> d32_signed;
  const hn::RebindToSigned<decltype(d16)> d16_signed;
  const hn::RebindToFloat<decltype(d32)> d;
  const hn::Rebind<T, decltype(d16)> d_part;
  const hn::CappedTag<T, kBlock> d_full;
  using Floats = hn::VFromD<decltype(d)>;
  const int part = static_cast<int>(hn::Lanes(d16));
  const int full = static_cast<int>(hn::Lanes(d_full));
  const auto neutral = hn::Set(d, 128.0F * 256.0F);
  const auto black = hn::Set(d, factors.black);
  const auto grey_factor = hn::Set(d, factors.grey);
  const auto red_of_red = hn::Set(d, factors.red_of_red);
  const auto green_of_red = hn::Set(d, factors.green_of_red);
  const auto green_of_blue = hn::Set(d, factors.green_of_blue);
  const auto blue_of_blue = hn::Set(d, factors.blue_of_blue);
  const auto half = hn::Set(d, 0.5F);
  // The lower and the upper halves of blocks, which rounded() joins again.
  const auto load = [&](const std::uint16_t* samples, bool upper) HWY_ATTR {
    const auto words = hn::LoadU(d16, samples);
    const auto zero = hn::Zero(d16);
    const auto wide =
        upper ? hn::InterleaveUpper(d16, words, zero) : hn::InterleaveLower(d16, words, zero);
    return hn::ConvertTo(d, hn::BitCast(d32_signed, wide));
  };
  // Rounded down and clamped to the type: narrowing saturates, for 16 bits around the middle.
  constexpr std::int32_t kMiddle = sizeof(T) == 1 ? 0 : 32768;
  const auto store = [&](const Floats* levels, T* channel) HWY_ATTR {
    const auto whole = [&](Floats level) HWY_ATTR {
      return hn::Sub(hn::ConvertTo(d32_signed, hn::Add(level, half)), hn::Set(d32_signed, kMiddle));
    };
    const auto words = hn::ReorderDemote2To(d16_signed, whole(levels[0]), whole(levels[1]));
    if constexpr (sizeof(T) == 1) {
      hn::StoreU(hn::DemoteTo(d_part, words), d_part, channel);
    } else {
      hn::StoreU(hn::Xor(hn::BitCast(d16, words), hn::Set(d16, kMiddle)), d16, channel);
    }
  };
  HWY_ALIGN T reds[kBlock];
  HWY_ALIGN T greens[kBlock];
  HWY_ALIGN T blues[kBlock];
  int x = 0;
  for (; x + kBlock <= row.width; x += kBlock) {
    for (int i = 0; i < kBlock; i += part) {
      Floats red_levels[2];
      Floats green_levels[2];
      Floats blue_levels[2];
      for (int k = 0; k < 2; ++k) {
        // Mul and Add, never MulAdd: results must not depend on the instruction set.
        const auto grey = hn::Mul(hn::Sub(load(row.luma + x + i, k == 1), black), grey_factor);
        const auto blue = hn::Sub(load(row.chroma_blue + x + i, k == 1), neutral);
        const auto red = hn::Sub(load(row.chroma_red + x + i, k == 1), neutral);
        red_levels[k] = hn::Add(grey, hn::Mul(red_of_red, red));
        green_levels[k] =
            hn::Sub(hn::Sub(grey, hn::Mul(green_of_red, red)), hn::Mul(green_of_blue, blue));
        blue_levels[k] = hn::Add(grey, hn::Mul(blue_of_blue, blue));
      }
      store(red_levels, reds + i);
      store(green_levels, greens + i);
      store(blue_levels, blues + i);
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
