#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/small_census/small_census_simd.cc"
#include <hwy/foreach_target.h>
// After foreach_target.h, so that it is compiled once per target.
#include <hwy/highway.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "kernels/candidates.h"
#include "kernels/cells/byte_cells-inl.h"
#include "kernels/small_census/small_census.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

#if HWY_TARGET == HWY_SCALAR
void hamming(const SmallCensusPairs& row, float* cells) { small_hamming_row_ref(row, cells); }
void likelihoods(const SmallCensusPairs& row, const LikelihoodByDistance& table, float* cells) {
  small_census_likelihood_row_ref(row, table, cells);
}
void energies(const SmallCensusPairs& row, const EnergyByDistance& table, std::uint8_t* cells) {
  small_census_energy_row_ref(row, table, cells);
}
#else

// One column's codes, in every lane.
template <class D8>
struct ReferenceCodes {
  VecOf<D8> byte[3][kSmallCensusBytes];
};

// Distances of the candidates of one column from lane `at` of its partners on, all channels
// together: at most 72.
template <int kChannels, class D8>
HWY_INLINE VecOf<D8> distances(D8 d, const SmallCensusPairs& row,
                               const ReferenceCodes<D8>& reference, std::ptrdiff_t at) {
  auto sum = hn::Zero(d);
#pragma GCC unroll 3
  for (int c = 0; c < kChannels; ++c) {
    const auto& partner = row.channel[static_cast<std::size_t>(c)].partner;
#pragma GCC unroll 3
    for (std::size_t p = 0; p < kSmallCensusBytes; ++p) {
      const auto other = hn::LoadU(d, partner[p] + at);
      sum = hn::Add(sum, bits_of_bytes(d, hn::Xor(reference.byte[c][p], other)));
    }
  }
  return sum;
}

// Calls cell(d, distances, lane) for the vectors of D8's size of one column, as long as whole ones
// fit; returns the first lane that is left.
template <int kChannels, class D8, class Cell>
HWY_INLINE int each_vector(D8 d, const SmallCensusPairs& row, int column, int lane,
                           const Cell& cell) {
  const int step = static_cast<int>(hn::Lanes(d));
  if (lane + step > row.lanes) {
    return lane;
  }
  ReferenceCodes<D8> reference;
#pragma GCC unroll 3
  for (int c = 0; c < kChannels; ++c) {
    const auto& planes = row.channel[static_cast<std::size_t>(c)].reference;
#pragma GCC unroll 3
    for (std::size_t p = 0; p < kSmallCensusBytes; ++p) {
      reference.byte[c][p] = hn::Set(d, planes[p][column]);
    }
  }
  const std::ptrdiff_t first = static_cast<std::ptrdiff_t>(column) * row.partner_step;
  for (; lane + step <= row.lanes; lane += step) {
    cell(d, distances<kChannels>(d, row, reference, first + lane), lane);
  }
  return lane;
}

// The same with all lanes of a column, which are a multiple of 16.
template <int kChannels, class Cell>
HWY_INLINE void each_lane(const SmallCensusPairs& row, int column, const Cell& cell) {
  int lane = each_vector<kChannels>(hn::ScalableTag<std::uint8_t>(), row, column, 0, cell);
  lane = each_vector<kChannels>(hn::CappedTag<std::uint8_t, 32>(), row, column, lane, cell);
  each_vector<kChannels>(hn::CappedTag<std::uint8_t, 16>(), row, column, lane, cell);
}

// The four bytes of each cell, least significant first and in grouped order, as floats in order.
template <class D8>
HWY_INLINE void store_floats(D8 d, const VecOf<D8> (&bytes)[4], float* cells) {
  const Tag16<D8> d16;
  const TagFloat<D8> df;
  const std::size_t n = hn::Lanes(df);
  const auto store = [&](VecOf<D8> low, VecOf<D8> high, float* at) HWY_ATTR {
    const auto lower = hn::BitCast(d16, low);
    const auto upper = hn::BitCast(d16, high);
    hn::StoreU(hn::BitCast(df, hn::InterleaveLower(d16, lower, upper)), df, at);
    hn::StoreU(hn::BitCast(df, hn::InterleaveUpper(d16, lower, upper)), df, at + n);
  };
  store(hn::InterleaveLower(d, bytes[0], bytes[1]), hn::InterleaveLower(d, bytes[2], bytes[3]),
        cells);
  store(hn::InterleaveUpper(d, bytes[0], bytes[1]), hn::InterleaveUpper(d, bytes[2], bytes[3]),
        cells + 2 * n);
}

// table[index], index < 32.
template <class D8>
HWY_INLINE VecOf<D8> looked_up(D8 d, const std::uint8_t* table, VecOf<D8> index) {
  const auto within = hn::And(index, hn::Set(d, 15));
  return hn::IfThenElse(hn::TestBit(index, hn::Set(d, 16)),
                        hn::TableLookupBytes(hn::LoadDup128(d, table + 16), within),
                        hn::TableLookupBytes(hn::LoadDup128(d, table), within));
}

template <int kChannels>
HWY_INLINE void hamming_columns(const SmallCensusPairs& row, float* cells) {
  for (int j = 0; j < row.columns; ++j, cells += row.lanes) {
    each_lane<kChannels>(row, j, [&](auto d, auto distance, int lane) HWY_ATTR {
      using D8 = decltype(d);
      const TagFloat<D8> df;
      const hn::RebindToSigned<Tag32<D8> > d32;
      const auto zero = hn::Zero(d);
      store_floats(d, {grouped(d, distance), zero, zero, zero}, cells + lane);
      // What was stored are integers.
      const auto share = hn::Set(df, 1.0F / kChannels);
      for (std::size_t k = 0; k < hn::Lanes(d); k += hn::Lanes(df)) {
        float* const at = cells + lane + k;
        const auto whole = hn::ConvertTo(df, hn::BitCast(d32, hn::LoadU(df, at)));
        hn::StoreU(kChannels > 1 ? hn::Mul(whole, share) : whole, df, at);
      }
    });
  }
}

void hamming(const SmallCensusPairs& row, float* cells) {
  if (row.channels == 1) {
    hamming_columns<1>(row, cells);
  } else {
    hamming_columns<3>(row, cells);
  }
}

void likelihoods(const SmallCensusPairs& row, const LikelihoodByDistance& table, float* cells) {
  for (int j = 0; j < row.columns; ++j, cells += row.lanes) {
    each_lane<1>(row, j, [&](auto d, auto distance, int lane) HWY_ATTR {
      const auto index = grouped(d, distance);
      store_floats(d,
                   {looked_up(d, table.bytes(0), index), looked_up(d, table.bytes(1), index),
                    looked_up(d, table.bytes(2), index), looked_up(d, table.bytes(3), index)},
                   cells + lane);
    });
    std::fill(cells + row.count, cells + row.lanes, 0.0F);
  }
}

// Energies of two columns of kLaneMultiple lanes, each in one half of a vector, which single ones
// would leave empty. Returns the first column that is left.
HWY_INLINE int energies_of_pairs(const SmallCensusPairs& row, const EnergyByDistance& table,
                                 std::uint8_t* cells) {
  if constexpr (hn::MaxLanes(hn::ScalableTag<std::uint8_t>()) < 2 * kLaneMultiple) {
    return 0;
  } else {
    const hn::CappedTag<std::uint8_t, 2 * kLaneMultiple> d;
    const hn::Half<decltype(d)> half;
    const auto& [reference, partner] = row.channel[0];
    const int end = row.columns - row.columns % 2;
    for (int j = 0; j < end; j += 2) {
      const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(j) * row.partner_step;
      auto distance = hn::Zero(d);
#pragma GCC unroll 3
      for (std::size_t p = 0; p < kSmallCensusBytes; ++p) {
        const auto own =
            hn::Combine(d, hn::Set(half, reference[p][j + 1]), hn::Set(half, reference[p][j]));
        const auto other = hn::Combine(d, hn::LoadU(half, partner[p] + at + row.partner_step),
                                       hn::LoadU(half, partner[p] + at));
        distance = hn::Add(distance, bits_of_bytes(d, hn::Xor(own, other)));
      }
      hn::StoreU(looked_up(d, table.steps.data(), distance), d,
                 cells + static_cast<std::ptrdiff_t>(j) * kLaneMultiple);
    }
    return end;
  }
}

void energies(const SmallCensusPairs& row, const EnergyByDistance& table, std::uint8_t* cells) {
  const int first = row.lanes == kLaneMultiple ? energies_of_pairs(row, table, cells) : 0;
  for (int j = first; j < row.columns; ++j) {
    std::uint8_t* const column = cells + static_cast<std::ptrdiff_t>(j) * row.lanes;
    each_lane<1>(row, j, [&](auto d, auto distance, int lane) HWY_ATTR {
      hn::StoreU(looked_up(d, table.steps.data(), distance), d, column + lane);
    });
  }
  for (int j = 0; row.count < row.lanes && j < row.columns; ++j, cells += row.lanes) {
    std::fill(cells + row.count, cells + row.lanes, std::numeric_limits<std::uint8_t>::max());
  }
}
#endif

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vantage::kernels {
HWY_EXPORT(hamming);
HWY_EXPORT(likelihoods);
HWY_EXPORT(energies);

void small_hamming_row(const SmallCensusPairs& row, float* cells) {
  HWY_DYNAMIC_DISPATCH(hamming)(row, cells);
}
void small_census_likelihood_row(const SmallCensusPairs& row, const LikelihoodByDistance& table,
                                 float* cells) {
  HWY_DYNAMIC_DISPATCH(likelihoods)(row, table, cells);
}
void small_census_energy_row(const SmallCensusPairs& row, const EnergyByDistance& table,
                             std::uint8_t* cells) {
  HWY_DYNAMIC_DISPATCH(energies)(row, table, cells);
}

}  // namespace vantage::kernels
#endif
