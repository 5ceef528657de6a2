#include "kernels/simd-inl.h"

#include <bit>
#include <cstddef>
#include <cstdint>

#include "kernels/candidates.h"
#include "kernels/census/census.h"
#include "kernels/feature_pairs-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {

using Tag = hn::ScalableTag<float>;
using Vec = hn::VFromD<Tag>;
using TagCode = hn::ScalableTag<std::uint32_t>;
using VecCode = hn::VFromD<TagCode>;
using Code = Features<std::uint32_t, 2>;

// Shifts `half` left and inserts the bit "neighbour is less than the centre".
HWY_INLINE void append(const float* neighbours, Vec centre, VecCode& half) {
  const Tag d;
  const TagCode d32;
  const auto is_less = hn::Lt(hn::LoadU(d, neighbours), centre);
  half = hn::Sub(hn::Add(half, half), hn::BitCast(d32, hn::VecFromMask(d, is_less)));
}

void census_codes(const CensusRows& rows, int width, std::uint32_t* first_half,
                  std::uint32_t* second_half) {
  const Tag d;
  const TagCode d32;
  for (int x = 0; x < width; x += static_cast<int>(hn::Lanes(d))) {
    const Vec centre = hn::LoadU(d, rows[kCensusRadiusY] + x);
    VecCode above = hn::Zero(d32);
    VecCode below = hn::Zero(d32);
    for (int v = 0; v < kCensusRadiusY; ++v) {
      for (int u = -kCensusRadiusX; u <= kCensusRadiusX; ++u) {
        append(rows[v] + x + u, centre, above);
      }
    }
    for (int u = 1; u <= kCensusRadiusX; ++u) {
      append(rows[kCensusRadiusY] + x + u - kCensusRadiusX - 1, centre, above);
      append(rows[kCensusRadiusY] + x + u, centre, below);
    }
    for (int v = kCensusRadiusY + 1; v <= 2 * kCensusRadiusY; ++v) {
      for (int u = -kCensusRadiusX; u <= kCensusRadiusX; ++u) {
        append(rows[v] + x + u, centre, below);
      }
    }
    hn::StoreU(above, d32, first_half + x);
    hn::StoreU(below, d32, second_half + x);
  }
}

// Stores the three bytes of a 24-bit code.
HWY_INLINE void store_code(VecCode code, int x, std::uint8_t* const* bytes) {
  const TagCode d32;
  const hn::Rebind<std::uint8_t, TagCode> d8;
  const VecCode min_byte = hn::Set(d32, 0xFF);
  const auto store = [&](VecCode bits, std::uint8_t* byte) HWY_ATTR {
    const auto low = hn::BitCast(hn::ScalableTag<std::int32_t>(), hn::And(bits, min_byte));
    hn::StoreU(hn::DemoteTo(d8, low), d8, byte + x);
  };
  store(hn::ShiftRight<16>(code), bytes[0]);
  store(hn::ShiftRight<8>(code), bytes[1]);
  store(code, bytes[2]);
}

HWY_INLINE const float* neighbours(const RayCensusRows& rows, int x, const PixelOffset& offset) {
  return rows[static_cast<std::size_t>(kRayCensusRadius + offset.rows)] + x + offset.columns;
}

// kThresholds: 1 or 3. Unrolled, so that offsets and bits are constants.
template <int kThresholds>
HWY_INLINE void ray_census_codes(const RayCensusRows& rows, int width,
                                 const RayCensusCodes& codes) {
  const Tag d;
  const TagCode d32;
  const Vec margin = hn::Set(d, kRayCensusMargin);
  for (int x = 0; x < width; x += static_cast<int>(hn::Lanes(d))) {
    const Vec centre = hn::LoadU(d, rows[kRayCensusRadius] + x);
    const Vec less = hn::Sub(centre, margin);
    const Vec more = hn::Add(centre, margin);
    VecCode upper = hn::Zero(d32);
    VecCode lower = hn::Zero(d32);
#pragma GCC unroll 24
    for (std::size_t k = 0; k < kRayCensusOffsets.size(); ++k) {
      const VecCode bit = hn::Set(d32, std::uint32_t{1} << (kRayCensusOffsets.size() - 1 - k));
      const auto append = [&](auto is_set, VecCode& code) HWY_ATTR {
        code = hn::Or(code, hn::IfThenElseZero(hn::RebindMask(d32, is_set), bit));
      };
      const Vec level = hn::LoadU(d, neighbours(rows, x, kRayCensusOffsets[k]));
      const auto is_upper = hn::Lt(level, centre);
      append(is_upper, upper);
      if constexpr (kThresholds > 1) {
        // Uses the outer threshold on the neighbour's side of the centre.
        append(hn::Lt(level, hn::IfThenElse(is_upper, less, more)), lower);
      }
    }
    store_code(upper, x, codes.data());
    if constexpr (kThresholds > 1) {
      store_code(lower, x, codes.data() + kRayCensusBytes);
    }
  }
}

void ray_census(const RayCensusRows& rows, int width, int thresholds, const RayCensusCodes& codes) {
  if (thresholds == 1) {
    ray_census_codes<1>(rows, width, codes);
  } else {
    ray_census_codes<kMaxRayCensusThresholds>(rows, width, codes);
  }
}

// Processes whole vectors from column x on, the last one ending at or after `end`. Returns the next
// column.
template <class D>
HWY_INLINE int byte_codes(D d, const ByteRayCensusRows& rows, int x, int end,
                          const RayCensusCodes& codes) {
  for (; x < end; x += static_cast<int>(hn::Lanes(d))) {
    const auto centre = hn::LoadU(d, rows[kRayCensusRadius] + x);
    for (std::size_t byte = 0; byte < kRayCensusBytes; ++byte) {
      auto code = hn::Zero(d);
      for (std::size_t bit = 0; bit < 8; ++bit) {
        const auto [columns, down] = kRayCensusOffsets[8 * byte + bit];
        const auto neighbour =
            hn::LoadU(d, rows[static_cast<std::size_t>(kRayCensusRadius + down)] + x + columns);
        // True is −1.
        code = hn::Sub(hn::Add(code, code), hn::VecFromMask(d, hn::Lt(neighbour, centre)));
      }
      hn::StoreU(code, d, codes[byte] + x);
    }
  }
  return x;
}

void byte_ray_census_codes(const ByteRayCensusRows& rows, int width, const RayCensusCodes& codes) {
  const hn::ScalableTag<std::uint8_t> d;
  const int whole = width - width % static_cast<int>(hn::Lanes(d));
  const int x = byte_codes(d, rows, 0, whole, codes);
  byte_codes(hn::CappedTag<std::uint8_t, kLaneMultiple>(), rows, x, width, codes);
}

// Sums the four bytes of each lane; no sum exceeds 255.
HWY_INLINE VecCode add_bytes(hn::VFromD<hn::Repartition<std::uint8_t, TagCode>> counts) {
  const TagCode d32;
  const VecCode of_bytes = hn::BitCast(d32, counts);
  const VecCode of_pairs = hn::Add(of_bytes, hn::ShiftRight<16>(of_bytes));
  return hn::And(hn::Add(of_pairs, hn::ShiftRight<8>(of_pairs)), hn::Set(d32, 0xFF));
}

// Number of set bits per lane, over all vectors of a code.
HWY_INLINE VecCode count_bits(const Code& code) {
  const hn::Repartition<std::uint8_t, TagCode> d8;
  return add_bytes(hn::Add(hn::PopulationCount(hn::BitCast(d8, code[0])),
                           hn::PopulationCount(hn::BitCast(d8, code[1]))));
}

struct Hamming {
  HWY_INLINE Vec operator()(const Code& reference, const Code& partner) const {
    const Code different{hn::Xor(reference[0], partner[0]), hn::Xor(reference[1], partner[1])};
    return hn::ConvertTo(Tag(),
                         hn::BitCast(hn::ScalableTag<std::int32_t>(), count_bits(different)));
  }
  HWY_INLINE Vec finish(Vec cost) const { return cost; }
};

void hamming(const CensusPairs& row, float* cells) { compare_row<false>(row, Hamming(), cells); }

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vantage::kernels {
HWY_EXPORT(census_codes);
HWY_EXPORT(hamming);
HWY_EXPORT(ray_census);
HWY_EXPORT(byte_ray_census_codes);

void census_code_row(const CensusRows& rows, int width, std::uint32_t* first_half,
                     std::uint32_t* second_half) {
  HWY_DYNAMIC_DISPATCH(census_codes)(rows, width, first_half, second_half);
}
void hamming_row(const CensusPairs& row, float* cells) {
  HWY_DYNAMIC_DISPATCH(hamming)(row, cells);
}
void ray_census_code_row(const RayCensusRows& rows, int width, int thresholds,
                         const RayCensusCodes& codes) {
  HWY_DYNAMIC_DISPATCH(ray_census)(rows, width, thresholds, codes);
}
void byte_ray_census_code_row(const ByteRayCensusRows& rows, int width,
                              const RayCensusCodes& codes) {
  HWY_DYNAMIC_DISPATCH(byte_ray_census_codes)(rows, width, codes);
}

}  // namespace vantage::kernels
#endif
