#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/window_evidence/window_evidence_simd.cc"
#include <hwy/foreach_target.h>
// After foreach_target.h, so that it is compiled once per target.
#include <hwy/highway.h>

#include <cstddef>
#include <cstdint>
#include <cstring>

#include "kernels/cells/byte_cells-inl.h"
#include "kernels/window_evidence/window_evidence.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

#if HWY_TARGET == HWY_SCALAR
void evidence(const WindowEvidenceRow& row, const EvidenceByDistance& by_distance,
              const std::array<WindowCells*, kWindows>& evidence) {
  window_evidence_row_ref(row, by_distance, evidence);
}
#else

// The two pixels of a row are the two halves of a 16-byte block; the two rows are the blocks of a
// vector, or two vectors.
using TagBlock = hn::CappedTag<std::uint8_t, 16>;
using TagRows = hn::CappedTag<std::uint8_t, 32>;
using VecBlock = hn::VFromD<TagBlock>;
using VecRows = hn::VFromD<TagRows>;
constexpr std::size_t kVectorRows = hn::MaxLanes(TagRows()) / 16;

// Lookups within blocks.
struct Places {
  alignas(32) std::uint8_t of_own[32];     // a pixel's byte, of two bytes, to its half
  alignas(32) std::uint8_t forwards[32];   // partners at and after the byte of the left pixel
  alignas(32) std::uint8_t backwards[32];  // partners at and before it
};
constexpr Places places() {
  Places places{};
  for (int i = 0; i < 32; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const int half = i % 16 / 8;
    places.of_own[at] = static_cast<std::uint8_t>(half);
    places.forwards[at] = static_cast<std::uint8_t>(i % 8 + half);
    places.backwards[at] = static_cast<std::uint8_t>(7 - i % 8 + half);
  }
  return places;
}
constexpr Places kPlaces = places();

// One vector of the blocks of its rows; block(row) makes one.
template <class D, class Block>
HWY_INLINE hn::VFromD<D> rows_of(D d, std::size_t first_row, const Block& block) {
  if constexpr (hn::MaxLanes(D()) == 16) {
    (void)d;
    return block(first_row);
  } else {
    (void)first_row;
    return hn::Combine(d, block(std::size_t{1}), block(std::size_t{0}));
  }
}

// The sum of the blocks of a vector.
template <class D>
HWY_INLINE VecBlock sum_of_blocks(D /*d*/, hn::VFromD<D> rows) {
  const TagBlock block;
  if constexpr (hn::MaxLanes(D()) == 16) {
    return rows;
  } else {
    return hn::Add(hn::LowerHalf(block, rows), hn::UpperHalf(block, rows));
  }
}

class Windows {
 public:
  Windows(const WindowEvidenceRow& row, const EvidenceByDistance& by_distance)
      : direction_(row.direction),
        before_(row.direction < 0 ? kWindowCandidates - 1 : 0),
        places_(hn::Load(TagRows(), row.direction < 0 ? kPlaces.backwards : kPlaces.forwards)),
        own_places_(hn::Load(TagRows(), kPlaces.of_own)),
        near_(hn::LoadDup128(TagRows(), by_distance.steps.data())),
        far_(hn::LoadDup128(TagRows(), by_distance.steps.data() + 16)) {
    for (std::size_t p = 0; p < kRayCensusBytes; ++p) {
      for (std::size_t r = 0; r < 2; ++r) {
        reference_[p][r] = row.reference[r][p];
        partner_[p][r] = row.partner[r][p];
      }
    }
  }

  [[nodiscard]] HWY_INLINE WindowCells of(int x, int start) const {
    const TagBlock block;
    const std::ptrdiff_t first = std::ptrdiff_t{2} * x + direction_ * start - before_;
    VecBlock of_pixels = hn::Zero(block);
    for (std::size_t r = 0; r < 2; r += kVectorRows) {
      of_pixels =
          hn::Add(of_pixels, sum_of_blocks(TagRows(), of_rows(r, std::ptrdiff_t{2} * x, first)));
    }
    const hn::Repartition<std::uint64_t, TagBlock> d64;
    const auto left = hn::BitCast(d64, of_pixels);
    const auto right = hn::BitCast(d64, hn::ShiftRightBytes<8>(block, of_pixels));
    return hn::GetLane(
        hn::BitCast(d64, hn::Add(hn::BitCast(block, left), hn::BitCast(block, right))));
  }

 private:
  [[nodiscard]] HWY_INLINE VecRows of_rows(std::size_t first_row, std::ptrdiff_t pixel,
                                           std::ptrdiff_t first) const {
    const TagRows d;
    const TagBlock block;
    const hn::Repartition<std::uint16_t, TagBlock> words;
    VecRows distance = hn::Zero(d);
#pragma GCC unroll 3
    for (std::size_t p = 0; p < kRayCensusBytes; ++p) {
      const VecRows others = hn::TableLookupBytes(
          rows_of(d, first_row,
                  [&](std::size_t r) HWY_ATTR { return hn::LoadU(block, partner_[p][r] + first); }),
          places_);
      const VecRows own = hn::TableLookupBytes(
          rows_of(d, first_row,
                  [&](std::size_t r) HWY_ATTR {
                    std::uint16_t bytes;
                    std::memcpy(&bytes, reference_[p][r] + pixel, sizeof(bytes));
                    return hn::BitCast(block, hn::Set(words, bytes));
                  }),
          own_places_);
      distance = hn::Add(distance, bits_of_bytes(d, hn::Xor(own, others)));
    }
    const VecRows within = hn::And(distance, hn::Set(d, 15));
    return hn::IfThenElse(hn::Gt(distance, hn::Set(d, 15)), hn::TableLookupBytes(far_, within),
                          hn::TableLookupBytes(near_, within));
  }

  std::ptrdiff_t direction_;
  std::ptrdiff_t
      before_;  // bytes from the first one loaded to the left pixel's at the window's start
  VecRows places_;
  VecRows own_places_;
  VecRows near_;
  VecRows far_;
  const std::uint8_t* reference_[kRayCensusBytes][2];
  const std::uint8_t* partner_[kRayCensusBytes][2];
};

void evidence(const WindowEvidenceRow& row, const EvidenceByDistance& by_distance,
              const std::array<WindowCells*, kWindows>& evidence) {
  const Windows windows(row, by_distance);
  const auto [first, second] = evidence;
  const auto [first_start, second_start] = row.start;
  const std::uint8_t* const has_second = row.has_second;
  const int columns = row.columns;
  for (int x = 0; x < columns; ++x) {
    first[x] = windows.of(x, first_start[x]);
    second[x] = has_second[x] != 0 ? windows.of(x, second_start[x]) : 0;
  }
}
#endif

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vantage::kernels {
HWY_EXPORT(evidence);

void window_evidence_row(const WindowEvidenceRow& row, const EvidenceByDistance& by_distance,
                         const std::array<WindowCells*, kWindows>& evidence) {
  HWY_DYNAMIC_DISPATCH(evidence)(row, by_distance, evidence);
}

}  // namespace vantage::kernels
#endif
