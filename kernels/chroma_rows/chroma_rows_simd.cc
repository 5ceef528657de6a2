#include "kernels/simd-inl.h"

#include <algorithm>
#include <cstddef>

#include "kernels/chroma_rows/chroma_rows.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {

// Pixels that are converted at a time; whole vectors of bytes. Rows end with a block that has the
// end of the one before in its rest.
constexpr int kChromaBlock = 128;
constexpr int kLumaShift = 15;
constexpr int kChromaShift = 18;  // sums of two rows and of three columns have a weight of 8
constexpr std::int32_t kNeutral = 128;

struct ChannelBlock {
  HWY_ALIGN std::uint8_t levels[2][3][kChromaBlock];
  /// Sums of both rows, after that of the column before the block.
  static constexpr int kFirst = 32;
  HWY_ALIGN std::uint16_t sums[3][kFirst + kChromaBlock];
};

HWY_INLINE void take_apart(const std::uint8_t* HWY_RESTRICT upper,
                           const std::uint8_t* HWY_RESTRICT lower, ChannelBlock& block) {
  const hn::CappedTag<std::uint8_t, kChromaBlock / 2> d8;
  const hn::Half<decltype(d8)> d8_half;
  const hn::RepartitionToWide<decltype(d8)> d16;
  const int lanes = static_cast<int>(hn::Lanes(d8));
  for (int x = 0; x < kChromaBlock; x += lanes) {
    for (int row = 0; row < 2; ++row) {
      auto red = hn::Zero(d8);
      auto green = red;
      auto blue = red;
      hn::LoadInterleaved3(d8, (row == 0 ? upper : lower) + 3 * x, red, green, blue);
      hn::Store(red, d8, block.levels[row][0] + x);
      hn::Store(green, d8, block.levels[row][1] + x);
      hn::Store(blue, d8, block.levels[row][2] + x);
    }
    for (int channel = 0; channel < 3; ++channel) {
      for (int part = 0; part < lanes; part += lanes / 2) {
        const auto level = [&](int row) HWY_ATTR {
          return hn::PromoteTo(d16, hn::LoadU(d8_half, block.levels[row][channel] + x + part));
        };
        hn::StoreU(hn::Add(level(0), level(1)), d16,
                   block.sums[channel] + ChannelBlock::kFirst + x + part);
      }
    }
  }
}

HWY_INLINE void luma_row(const std::uint8_t (*levels)[kChromaBlock], const ChromaFactors& factors,
                         std::uint8_t* HWY_RESTRICT luma) {
  const hn::CappedTag<std::int32_t, 16> d;
  const hn::Rebind<std::uint8_t, decltype(d)> d8;
  const auto red = hn::Set(d, factors.luma[0]);
  const auto green = hn::Set(d, factors.luma[1]);
  const auto blue = hn::Set(d, factors.luma[2]);
  const auto black = hn::Set(d, (2 * factors.black + 1) << (kLumaShift - 1));
  const auto load = [&](const std::uint8_t* level)
                        HWY_ATTR { return hn::PromoteTo(d, hn::LoadU(d8, level)); };
  for (int x = 0; x < kChromaBlock; x += static_cast<int>(hn::Lanes(d))) {
    const auto sum =
        hn::Add(hn::Add(hn::Mul(load(levels[0] + x), red), hn::Mul(load(levels[1] + x), green)),
                hn::Add(hn::Mul(load(levels[2] + x), blue), black));
    hn::StoreU(hn::DemoteTo(d8, hn::ShiftRight<kLumaShift>(sum)), d8, luma + x);
  }
}

HWY_INLINE void chroma_row(const ChannelBlock& block, const ChromaFactors& factors,
                           std::uint8_t* HWY_RESTRICT blue, std::uint8_t* HWY_RESTRICT red) {
  const hn::CappedTag<std::int32_t, 16> d;
  const hn::Rebind<std::uint8_t, decltype(d)> d8;
  const hn::RepartitionToNarrow<decltype(d)> d16;
  const auto even = hn::Set(d, 0xFFFF);
  const auto neutral = hn::Set(d, (2 * kNeutral + 1) << (kChromaShift - 1));
  for (int i = 0; i < kChromaBlock / 2; i += static_cast<int>(hn::Lanes(d))) {
    auto blue_sum = neutral;
    auto red_sum = neutral;
    for (int channel = 0; channel < 3; ++channel) {
      const auto* here =
          reinterpret_cast<const std::int16_t*>(block.sums[channel]) + ChannelBlock::kFirst + 2 * i;
      // Two columns a lane.
      const auto columns = hn::BitCast(d, hn::LoadU(d16, here));
      const auto before = hn::ShiftRight<16>(hn::BitCast(d, hn::LoadU(d16, here - 2)));
      const auto level = hn::Add(hn::Add(before, hn::ShiftRight<16>(columns)),
                                 hn::ShiftLeft<1>(hn::And(columns, even)));
      const auto c = static_cast<std::size_t>(channel);
      blue_sum = hn::Add(blue_sum, hn::Mul(level, hn::Set(d, factors.chroma_blue[c])));
      red_sum = hn::Add(red_sum, hn::Mul(level, hn::Set(d, factors.chroma_red[c])));
    }
    hn::StoreU(hn::DemoteTo(d8, hn::ShiftRight<kChromaShift>(blue_sum)), d8, blue + i);
    hn::StoreU(hn::DemoteTo(d8, hn::ShiftRight<kChromaShift>(red_sum)), d8, red + i);
  }
}

void chroma_rows_all(const ChromaRows& rows, const ChromaFactors& factors) {
  ChannelBlock block;
  HWY_ALIGN std::uint8_t rgb[2][3 * kChromaBlock] = {};
  HWY_ALIGN std::uint8_t results[4][kChromaBlock];
  constexpr int kBefore = ChannelBlock::kFirst - 1;
  for (int channel = 0; channel < 3; ++channel) {
    block.sums[channel][kBefore + kChromaBlock] =
        static_cast<std::uint16_t>(rows.rgb[0][channel] + rows.rgb[1][channel]);
  }
  for (int x = 0; x < rows.width; x += kChromaBlock) {
    const int width = std::min(kChromaBlock, rows.width - x);
    for (std::size_t row = 0; row < 2; ++row) {
      std::copy_n(rows.rgb[row] + 3 * x, 3 * width, rgb[row]);
    }
    for (auto& sums : block.sums) {
      sums[kBefore] = sums[kBefore + kChromaBlock];
    }
    take_apart(rgb[0], rgb[1], block);
    luma_row(block.levels[0], factors, results[0]);
    luma_row(block.levels[1], factors, results[1]);
    chroma_row(block, factors, results[2], results[3]);
    std::copy_n(results[0], width, rows.luma[0] + x);
    std::copy_n(results[1], width, rows.luma[1] + x);
    std::copy_n(results[2], width / 2, rows.chroma_blue + x / 2);
    std::copy_n(results[3], width / 2, rows.chroma_red + x / 2);
  }
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vantage::kernels {
HWY_EXPORT(chroma_rows_all);

void chroma_rows(const ChromaRows& rows, const ChromaFactors& factors) {
  HWY_DYNAMIC_DISPATCH(chroma_rows_all)(rows, factors);
}

}  // namespace vantage::kernels
#endif  // HWY_ONCE
