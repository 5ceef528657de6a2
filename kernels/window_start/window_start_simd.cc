#include "kernels/simd-inl.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "kernels/window_start/window_start.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {

void second_winners(const std::array<const std::int16_t*, 3>& winners, int columns,
                    std::int16_t* second) {
  const hn::CappedTag<std::int16_t, kWindowMargin> d;
  const auto [above, here, below] = winners;
  const auto other = hn::Set(d, kOtherSurface);
  const auto none = hn::Set(d, kNoSecondWinner);
  for (int x = 0; x < columns; x += static_cast<int>(hn::Lanes(d))) {
    const auto own = hn::LoadU(d, here + x);
    auto min = own;
    auto max = own;
    for (int at = x - 1; at <= x + 1; ++at) {
      const auto up = hn::LoadU(d, above + at);
      const auto middle = hn::LoadU(d, here + at);
      const auto down = hn::LoadU(d, below + at);
      min = hn::Min(min, hn::Min(hn::Min(up, middle), down));
      max = hn::Max(max, hn::Max(hn::Max(up, middle), down));
    }
    const auto above_or_none = hn::IfThenElse(hn::Lt(hn::Sub(max, own), other), none, max);
    hn::StoreU(hn::IfThenElse(hn::Lt(hn::Sub(own, min), other), above_or_none, min), d, second + x);
  }
}

// Energies of the windows of a vector of columns, from x on.
template <int kSpacing, class D64>
HWY_INLINE hn::VFromD<D64> energies_at(D64 d64, const CoarseEnergies& coarse, int x) {
  const auto coarse_cells = hn::LoadU(d64, coarse.energies + x);
  if constexpr (kSpacing == 1) {
    return coarse_cells;
  } else {
    const hn::Repartition<std::uint8_t, D64> d8;
    constexpr int kColumns = static_cast<int>(hn::MaxLanes(D64()));
    const auto even = hn::BitCast(d8, coarse_cells);
    const auto odd = hn::AverageRound(even, hn::BitCast(d8, hn::ShiftRight<8>(coarse_cells)));
    // All sixteen energies of the columns of a block, then the lower and upper halves of each.
    const auto first = hn::BitCast(d64, hn::InterleaveLower(d8, even, odd));
    const auto second = hn::BitCast(d64, hn::InterleaveUpper(d8, even, odd));
    const auto low = hn::InterleaveLower(d64, first, second);
    const auto high = hn::InterleaveUpper(d64, first, second);
    HWY_ALIGN std::uint64_t bits[kColumns];
    for (int j = 0; j < kColumns; ++j) {
      bits[j] = coarse.offset_bits[x + j];
    }
    const auto down = hn::Load(d64, bits);
    // By 64 − down in two steps: not all targets shift by all bits of a lane.
    const auto up = hn::Sub(hn::Set(d64, 63), down);
    return hn::Or(hn::Shr(low, down), hn::Shl(hn::ShiftLeft<1>(high), up));
  }
}

template <int kSpacing>
HWY_INLINE void start_spaced(const CoarseEnergies& given, WindowCells* support) {
  const CoarseEnergies coarse = given;  // a copy: stores cannot alias it
  const hn::ScalableTag<std::uint64_t> d64;
  const hn::Repartition<std::uint16_t, decltype(d64)> d16;
  constexpr int kColumns = static_cast<int>(hn::MaxLanes(d64));
  const auto steps = hn::Set(d16, coarse.steps);
  const auto ceiling = hn::Set(d16, coarse.ceiling);
  const auto lanes = hn::Set(d64, coarse.lanes);
  const auto upper = hn::Set(d16, 0xFF00);
  for (int x = 0; x < coarse.columns; x += kColumns) {
    const auto energies = hn::BitCast(d16, energies_at<kSpacing>(d64, coarse, x));
    const auto cells = [&](auto energy) HWY_ATTR {
      return hn::SaturatedSub(ceiling, hn::MulHigh(energy, steps));
    };
    const auto even_cells = cells(hn::ShiftLeft<8>(energies));
    const auto odd_cells = cells(hn::And(energies, upper));
    const auto result = hn::BitCast(d64, hn::Or(even_cells, hn::ShiftLeft<8>(odd_cells)));
    hn::StoreU(hn::And(result, lanes), d64, support + x);
  }
}

void start(const CoarseEnergies& coarse, WindowCells* support) {
  if (coarse.spacing == 1) {
    start_spaced<1>(coarse, support);
  } else {
    start_spaced<2>(coarse, support);
  }
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vantage::kernels {
HWY_EXPORT(second_winners);
HWY_EXPORT(start);

void second_winners_row(const std::array<const std::int16_t*, 3>& winners, int columns,
                        std::int16_t* second) {
  HWY_DYNAMIC_DISPATCH(second_winners)(winners, columns, second);
}
void window_start_row(const CoarseEnergies& coarse, WindowCells* support) {
  HWY_DYNAMIC_DISPATCH(start)(coarse, support);
}

// Scalar reference.

void second_winners_row_ref(const std::array<const std::int16_t*, 3>& winners, int columns,
                            std::int16_t* second) {
  for (int x = 0; x < columns; ++x) {
    const int own = winners[1][x];
    int min = own;
    int max = own;
    for (const std::int16_t* const row : winners) {
      for (int at = x - 1; at <= x + 1; ++at) {
        min = std::min<int>(min, row[at]);
        max = std::max<int>(max, row[at]);
      }
    }
    const int other = own - min >= kOtherSurface   ? min
                      : max - own >= kOtherSurface ? max
                                                   : kNoSecondWinner;
    second[x] = static_cast<std::int16_t>(other);
  }
}

void window_start_row_ref(const CoarseEnergies& coarse, WindowCells* support) {
  for (int x = 0; x < coarse.columns; ++x) {
    support[x] = 0;
    for (int k = 0; k < kWindowCandidates; ++k) {
      const int at = coarse.spacing == 1 ? 2 * k : k + coarse.offset_bits[x] / 8;
      const int energy = window_cell(coarse.energies[x], at / 2);
      const int next = at % 2 == 0 ? energy : window_cell(coarse.energies[x], at / 2 + 1);
      const int steps = ((energy + next + 1) / 2 * coarse.steps) >> 8;
      support[x] |= static_cast<WindowCells>(std::max(0, coarse.ceiling - steps)) << (8 * k);
    }
    support[x] &= coarse.lanes;
  }
}

}  // namespace vantage::kernels
#endif
