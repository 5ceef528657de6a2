#include "kernels/simd-inl.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <type_traits>

#include "kernels/candidates.h"
#include "kernels/cells/byte_cells-inl.h"
#include "kernels/ray_census/ray_census-inl.h"
#include "kernels/ray_census/ray_census.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {

// Codes of one column, in every lane.
template <int kChannels, int kThresholds, class D8>
struct ReferenceCodes {
  VecOf<D8> byte[kChannels][ray_census_bytes(kThresholds)];
};

// Distances to the codes whose bytes partner(channel, byte) loads, summed over all channels: at
// most 216.
template <int kChannels, int kThresholds, class D8, class Partner>
HWY_INLINE VecOf<D8> distances(D8 d, const ReferenceCodes<kChannels, kThresholds, D8>& reference,
                               const Partner& partner) {
  CodeDistance<kThresholds, D8> distance(d);
#pragma GCC unroll 3
  for (std::size_t c = 0; c < kChannels; ++c) {
    distance.add(
        d, [&](std::size_t p) HWY_ATTR { return reference.byte[c][p]; },
        [&](std::size_t p) HWY_ATTR { return partner(c, p); });
  }
  return distance.value();
}

// Calls cell(d, distances, lane) for the vectors of D8's size of one column while whole vectors
// fit. Returns the first remaining lane.
template <int kChannels, int kThresholds, class D8, class Cell>
HWY_INLINE int each_vector(D8 d, const RayCensusPairs& row, int column, int lane,
                           const Cell& cell) {
  const int step = static_cast<int>(hn::Lanes(d));
  if (lane + step > row.lanes) {
    return lane;
  }
  ReferenceCodes<kChannels, kThresholds, D8> reference;
#pragma GCC unroll 3
  for (int c = 0; c < kChannels; ++c) {
    const auto& planes = row.channel[static_cast<std::size_t>(c)].reference;
    for (std::size_t p = 0; p < ray_census_bytes(kThresholds); ++p) {
      reference.byte[c][p] = hn::Set(d, planes[p][column]);
    }
  }
  const std::ptrdiff_t first = static_cast<std::ptrdiff_t>(column) * row.partner_step;
  for (; lane + step <= row.lanes; lane += step) {
    const std::ptrdiff_t at = first + lane;
    cell(d,
         distances(d, reference,
                   [&](std::size_t c, std::size_t p)
                       HWY_ATTR { return hn::LoadU(d, row.channel[c].partner[p] + at); }),
         lane);
  }
  return lane;
}

// Same for all lanes of a column, a multiple of 16.
template <int kChannels, int kThresholds, class Cell>
HWY_INLINE void each_lane(const RayCensusPairs& row, int column, const Cell& cell) {
  int lane = 0;
  lane =
      each_vector<kChannels, kThresholds>(hn::ScalableTag<std::uint8_t>(), row, column, lane, cell);
  lane = each_vector<kChannels, kThresholds>(hn::CappedTag<std::uint8_t, 32>(), row, column, lane,
                                             cell);
  each_vector<kChannels, kThresholds>(hn::CappedTag<std::uint8_t, 16>(), row, column, lane, cell);
}

// Stores cells as floats in lane order; bytes[b] holds byte b of each cell (0 = least significant),
// in grouped order.
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

template <int kChannels, int kThresholds>
HWY_INLINE void hamming_columns(const RayCensusPairs& row, float* cells) {
  constexpr int kCodes = kChannels * kThresholds;
  for (int j = 0; j < row.columns; ++j, cells += row.lanes) {
    each_lane<kChannels, kThresholds>(row, j, [&](auto d, auto distance, int lane) HWY_ATTR {
      using D8 = decltype(d);
      const TagFloat<D8> df;
      const hn::RebindToSigned<Tag32<D8> > d32;
      const auto zero = hn::Zero(d);
      store_floats(d, {grouped(d, distance), zero, zero, zero}, cells + lane);
      // The stored values are integers.
      const auto share = hn::Set(df, 1.0F / kCodes);
      for (std::size_t k = 0; k < hn::Lanes(d); k += hn::Lanes(df)) {
        float* const at = cells + lane + k;
        const auto whole = hn::ConvertTo(df, hn::BitCast(d32, hn::LoadU(df, at)));
        hn::StoreU(kCodes > 1 ? hn::Mul(whole, share) : whole, df, at);
      }
    });
  }
}

template <int kThresholds>
HWY_INLINE void hamming_of_channels(const RayCensusPairs& row, float* cells) {
  if (row.channels == 1) {
    hamming_columns<1, kThresholds>(row, cells);
  } else {
    hamming_columns<3, kThresholds>(row, cells);
  }
}

void hamming(const RayCensusPairs& row, float* cells) {
  if (row.thresholds == 1) {
    hamming_of_channels<1>(row, cells);
  } else {
    hamming_of_channels<3>(row, cells);
  }
}

template <int kThresholds>
HWY_INLINE void likelihood_columns(const RayCensusPairs& row, const LikelihoodByDistance& table,
                                   float* cells) {
  constexpr int kEntries = ray_census_distances(kThresholds);
  for (int j = 0; j < row.columns; ++j, cells += row.lanes) {
    each_lane<1, kThresholds>(row, j, [&](auto d, auto distance, int lane) HWY_ATTR {
      const auto index = grouped(d, distance);
      store_floats(d,
                   {looked_up<kEntries>(d, table.bytes(0), index),
                    looked_up<kEntries>(d, table.bytes(1), index),
                    looked_up<kEntries>(d, table.bytes(2), index),
                    looked_up<kEntries>(d, table.bytes(3), index)},
                   cells + lane);
    });
    std::fill(cells + row.count, cells + row.lanes, 0.0F);
  }
}

void likelihoods(const RayCensusPairs& row, const LikelihoodByDistance& table, float* cells) {
  if (row.thresholds == 1) {
    likelihood_columns<1>(row, table, cells);
  } else {
    likelihood_columns<3>(row, table, cells);
  }
}

// The bytes of consecutive columns, kLaneMultiple lanes each.
template <class D8>
HWY_INLINE VecOf<D8> partners_of_columns(D8 d, const std::uint8_t* partner, std::ptrdiff_t step) {
  constexpr std::ptrdiff_t kColumns = hn::MaxLanes(D8()) / kLaneMultiple;
  if constexpr (kColumns == 1) {
    return hn::LoadU(d, partner);
  } else {
    const hn::Half<D8> half;
    return hn::Combine(d, partners_of_columns(half, partner + kColumns / 2 * step, step),
                       partners_of_columns(half, partner, step));
  }
}

// Each of consecutive bytes in all kLaneMultiple lanes of its column.
template <class D8>
HWY_INLINE VecOf<D8> references_of_columns(D8 d, const std::uint8_t* reference) {
  constexpr std::size_t kColumns = hn::MaxLanes(D8()) / kLaneMultiple;
  using Bytes = std::conditional_t<kColumns == 4, std::uint32_t, std::uint16_t>;
  const hn::Repartition<Bytes, D8> of_bytes;
  alignas(64) static constexpr std::uint8_t kColumn[64] = {
      0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1,
      1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 2, 2, 2, 2, 2, 2, 2, 2, 2, 2, 2, 2,
      2, 2, 2, 2, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3};
  Bytes bytes;
  std::memcpy(&bytes, reference, kColumns);
  return hn::TableLookupBytes(hn::BitCast(d, hn::Set(of_bytes, bytes)), hn::Load(d, kColumn));
}

// Energies of columns of kLaneMultiple lanes, as many as fit into a vector, which a single column
// would not fill. Starts at a column and returns the first remaining one.
template <int kThresholds, int kEntries, class D8>
HWY_INLINE int energies_of_several(D8 d, const RayCensusPairs& row, const ByteByDistance& table,
                                   int column, std::uint8_t* cells) {
  constexpr int kColumns = hn::MaxLanes(D8()) / kLaneMultiple;
  if constexpr (kColumns > 1) {
    const auto& reference = row.channel[0].reference;
    const auto& partner = row.channel[0].partner;
    const std::ptrdiff_t step = row.partner_step;
    for (; column + kColumns <= row.columns; column += kColumns) {
      const std::ptrdiff_t at = column * step;
      ReferenceCodes<1, kThresholds, D8> own;
#pragma GCC unroll 6
      for (std::size_t p = 0; p < ray_census_bytes(kThresholds); ++p) {
        own.byte[0][p] = references_of_columns(d, reference[p] + column);
      }
      const auto distance = distances(d, own, [&](std::size_t /*channel*/, std::size_t p) HWY_ATTR {
        return partners_of_columns(d, partner[p] + at, step);
      });
      hn::StoreU(looked_up_bytes<kEntries>(d, table, distance), d,
                 cells + static_cast<std::ptrdiff_t>(column) * kLaneMultiple);
    }
  }
  return column;
}

template <int kThresholds, int kEntries>
HWY_INLINE void energy_columns(const RayCensusPairs& given, const ByteByDistance& of_distances,
                               std::uint8_t* cells) {
  const RayCensusPairs row = given;  // copies: stores cannot alias them
  const ByteByDistance table = of_distances;
  int first = 0;
  if (row.lanes == kLaneMultiple) {
    first = energies_of_several<kThresholds, kEntries>(hn::ScalableTag<std::uint8_t>(), row, table,
                                                       first, cells);
    first = energies_of_several<kThresholds, kEntries>(
        hn::CappedTag<std::uint8_t, 2 * kLaneMultiple>(), row, table, first, cells);
  }
  for (int j = first; j < row.columns; ++j) {
    std::uint8_t* const column = cells + static_cast<std::ptrdiff_t>(j) * row.lanes;
    each_lane<1, kThresholds>(row, j, [&](auto d, auto distance, int lane) HWY_ATTR {
      hn::StoreU(looked_up_bytes<kEntries>(d, table, distance), d, column + lane);
    });
  }
  for (int j = 0; row.count < row.lanes && j < row.columns; ++j, cells += row.lanes) {
    std::fill(cells + row.count, cells + row.lanes, std::numeric_limits<std::uint8_t>::max());
  }
}

void energies(const RayCensusPairs& row, const ByteByDistance& table, std::uint8_t* cells) {
  with_entries(row.thresholds, table, [&](auto thresholds, auto entries) HWY_ATTR {
    energy_columns<decltype(thresholds)::value, decltype(entries)::value>(row, table, cells);
  });
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vantage::kernels {
HWY_EXPORT(hamming);
HWY_EXPORT(likelihoods);
HWY_EXPORT(energies);

void ray_hamming_row(const RayCensusPairs& row, float* cells) {
  HWY_DYNAMIC_DISPATCH(hamming)(row, cells);
}
void ray_census_likelihood_row(const RayCensusPairs& row, const LikelihoodByDistance& table,
                               float* cells) {
  HWY_DYNAMIC_DISPATCH(likelihoods)(row, table, cells);
}
void ray_census_energy_row(const RayCensusPairs& row, const ByteByDistance& table,
                           std::uint8_t* cells) {
  HWY_DYNAMIC_DISPATCH(energies)(row, table, cells);
}

LikelihoodByDistance::LikelihoodByDistance(
    const std::array<float, kMaxRayCensusDistances>& likelihoods) {
  for (std::size_t i = 0; i < likelihoods.size(); ++i) {
    const auto bits = std::bit_cast<std::uint32_t>(likelihoods[i]);
    for (std::size_t b = 0; b < bytes_.size(); ++b) {
      bytes_[b][i] = static_cast<std::uint8_t>(bits >> (8 * b));
    }
  }
}

float LikelihoodByDistance::at(int distance) const {
  std::uint32_t bits = 0;
  for (std::size_t b = 0; b < bytes_.size(); ++b) {
    bits |= std::uint32_t{bytes_[b][static_cast<std::size_t>(distance)]} << (8 * b);
  }
  return std::bit_cast<float>(bits);
}

}  // namespace vantage::kernels
#endif
