// Cells in vectors of bytes, one byte per cell. Included once per target by dispatched files.

#if defined(VANTAGE_KERNELS_BYTE_CELLS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VANTAGE_KERNELS_BYTE_CELLS_INL_H_
#undef VANTAGE_KERNELS_BYTE_CELLS_INL_H_
#else
#define VANTAGE_KERNELS_BYTE_CELLS_INL_H_
#endif

#include <cstddef>
#include <cstdint>

#include "kernels/simd-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {

// Cells are computed in vectors of bytes, one byte per cell, in `grouped` order: group g (four
// lanes) of float vector s of the four result vectors is group s of 128-bit block g. Interleaving
// bytes to words and words to floats then gives the lanes in order.

template <class D8>
using Tag16 = hn::Repartition<std::uint16_t, D8>;
template <class D8>
using Tag32 = hn::Repartition<std::uint32_t, D8>;
template <class D8>
using TagFloat = hn::Repartition<float, D8>;
template <class D>
using VecOf = hn::VFromD<D>;

// Converts bytes from lane order to grouped order.
template <class D8>
HWY_INLINE VecOf<D8> grouped(D8 d, VecOf<D8> bytes) {
  constexpr std::size_t kBlocks = hn::MaxLanes(D8()) / 16;
  if constexpr (kBlocks == 1) {
    return bytes;
  } else {
    const Tag32<D8> d32;
    HWY_ALIGN std::int32_t from[4 * kBlocks];
    for (std::size_t block = 0; block < kBlocks; ++block) {
      for (std::size_t group = 0; group < 4; ++group) {
        from[4 * block + group] = static_cast<std::int32_t>(group * kBlocks + block);
      }
    }
    return hn::BitCast(
        d, hn::TableLookupLanes(hn::BitCast(d32, bytes), hn::SetTableIndices(d32, from)));
  }
}

// Number of set bits in each byte.
template <class D8>
HWY_INLINE VecOf<D8> bits_of_bytes(D8 d, VecOf<D8> bytes) {
#if HWY_TARGET == HWY_AVX3_DL
  (void)d;
  return hn::PopulationCount(bytes);
#else
  alignas(16) static constexpr std::uint8_t kBits[16] = {0, 1, 1, 2, 1, 2, 2, 3,
                                                         1, 2, 2, 3, 2, 3, 3, 4};
  const Tag16<D8> d16;
  const auto table = hn::LoadDup128(d, kBits);
  const auto nibble = hn::Set(d, 15);
  const auto upper = hn::BitCast(d, hn::ShiftRight<4>(hn::BitCast(d16, bytes)));
  return hn::Add(hn::TableLookupBytes(table, hn::And(bytes, nibble)),
                 hn::TableLookupBytes(table, hn::And(upper, nibble)));
#endif
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
