// Distances of ray census codes in vectors of bytes, and lookups by them. Included once per target
// by dispatched files.

#if defined(VANTAGE_KERNELS_RAY_CENSUS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VANTAGE_KERNELS_RAY_CENSUS_INL_H_
#undef VANTAGE_KERNELS_RAY_CENSUS_INL_H_
#else
#define VANTAGE_KERNELS_RAY_CENSUS_INL_H_
#endif

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "kernels/cells/byte_cells-inl.h"
#include "kernels/census/census.h"
#include "kernels/ray_census/ray_census.h"
#include "kernels/simd-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {

// Sum of the distances of codes, byte by byte of eight neighbours.
template <int kThresholds, class D8>
class CodeDistance {
 public:
  explicit HWY_INLINE CodeDistance(D8 d) : ones_(hn::Zero(d)), twos_(hn::Zero(d)) {}

  // Adds a whole code. own(p), other(p): its bytes, see RayCensusCodes.
  template <class Own, class Other>
  HWY_INLINE void add(D8 d, const Own& own, const Other& other) {
#pragma GCC unroll 3
    for (std::size_t p = 0; p < kRayCensusBytes; ++p) {
      const auto own_upper = own(p);
      const auto upper = hn::Xor(own_upper, other(p));
      if constexpr (kThresholds == 1) {
        ones_ = hn::Add(ones_, bits_of_bytes(d, upper));
      } else {
        // |a − b| of two-bit numbers: 1 if the lower bits differ, plus 2 if the upper bits differ;
        // except for a, b = 1, 2: both bits differ, and a's bits differ from each other, so only 1
        // counts.
        const auto own_lower = own(p + kRayCensusBytes);
        const auto lower = hn::Xor(own_lower, other(p + kRayCensusBytes));
        const auto is_1_or_2 = hn::Xor(own_upper, own_lower);
        ones_ = hn::Add(ones_, bits_of_bytes(d, lower));
        twos_ = hn::Add(twos_, bits_of_bytes(d, hn::AndNot(hn::And(lower, is_1_or_2), upper)));
      }
    }
  }

  [[nodiscard]] HWY_INLINE VecOf<D8> value() const {
    return kThresholds == 1 ? ones_ : hn::Add(ones_, hn::Add(twos_, twos_));
  }

 private:
  VecOf<D8> ones_;
  VecOf<D8> twos_;
};

// table[index] for index < kEntries.
template <int kEntries, class D8>
HWY_INLINE VecOf<D8> looked_up(D8 d, const std::uint8_t* table, VecOf<D8> index) {
  // Distances are below 128, and comparing signed bytes is cheaper.
  const hn::RebindToSigned<D8> d8s;
  const auto within = hn::And(index, hn::Set(d, 15));
  auto value = hn::TableLookupBytes(hn::LoadDup128(d, table), within);
#pragma GCC unroll 4
  for (int first = 16; first < kEntries; first += 16) {
    const auto last_before = hn::Set(d8s, static_cast<std::int8_t>(first - 1));
    value = hn::IfThenElse(hn::RebindMask(d, hn::Gt(hn::BitCast(d8s, index), last_before)),
                           hn::TableLookupBytes(hn::LoadDup128(d, table + first), within), value);
  }
  return value;
}

// table.steps[distance]; kEntries: multiple of 16, above table.last.
template <int kEntries, class D8>
HWY_INLINE VecOf<D8> looked_up_bytes(D8 d, const ByteByDistance& table, VecOf<D8> distance) {
  const std::uint8_t* const steps = table.steps.data();
  const auto within = hn::Min(distance, hn::Set(d, static_cast<std::uint8_t>(table.last)));
#if HWY_TARGET == HWY_AVX3_DL
  // Highway has no lookup of bytes across blocks yet.
  if constexpr (kEntries <= 64 && hn::MaxLanes(D8()) == 64) {
    return VecOf<D8>{_mm512_permutexvar_epi8(within.raw, hn::Load(d, steps).raw)};
  } else if constexpr (kEntries <= 64 && hn::MaxLanes(D8()) == 32) {
    return VecOf<D8>{
        _mm256_permutex2var_epi8(hn::Load(d, steps).raw, within.raw, hn::Load(d, steps + 32).raw)};
  }
#endif
  return looked_up<kEntries>(d, steps, within);
}

// Calls body with the number of entries to look up, a constant, for codes of `thresholds`.
template <class Body>
HWY_INLINE void with_entries(int thresholds, const ByteByDistance& table, const Body& body) {
  using One = std::integral_constant<int, 1>;
  using Three = std::integral_constant<int, 3>;
  if (thresholds == 1) {
    if (table.last < 16) {
      body(One(), std::integral_constant<int, 16>());
    } else {
      body(One(), std::integral_constant<int, 32>());
    }
  } else if (table.last < 48) {
    body(Three(), std::integral_constant<int, 48>());
  } else {
    body(Three(), std::integral_constant<int, kRayCensusTableBytes>());
  }
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
