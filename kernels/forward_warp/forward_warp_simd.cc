#include "kernels/simd-inl.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernels/forward_warp/forward_warp.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {

// Columns whose targets are computed at a time; a multiple of every vector length.
constexpr int kBlock = 64;
// Farther than any row width, and safe to convert and to add to a column.
constexpr double kFarColumns = 1 << 29;

// Neighbouring columns plus one on each side: the end columns of the adjacent blocks.
struct Block {
  int begin = 0;  // column of element 1
  int count = 0;
  float disparity_px[kBlock + 2];   // NaN = unknown
  std::int32_t target[kBlock + 2];  // −1 and width represent everything outside the view
};

// floor(x − s·d + ½) for columns [first, first + count) of a block.
template <class D64>
HWY_INLINE void find_targets(D64 d64, const ForwardWarpRow& row, int first, int count,
                             Block& block) {
  const hn::Rebind<float, D64> d32;
  const hn::Rebind<std::int32_t, D64> di32;
  const auto largest = hn::Set(d32, std::numeric_limits<float>::max());
  const auto unknown = hn::Set(d32, std::numeric_limits<float>::quiet_NaN());
  const auto offset = hn::Set(d64, row.camera_offset);
  const auto far = hn::Set(d64, kFarColumns);
  const auto before = hn::Set(di32, -1);
  const auto after = hn::Set(di32, row.width);
  for (int i = first; i < first + count; i += static_cast<int>(hn::Lanes(d64))) {
    const auto read = hn::LoadU(d32, row.disparity_px + block.begin + i);
    const auto known = hn::Le(hn::Abs(read), largest);
    const auto exact = hn::Mul(offset, hn::PromoteTo(d64, hn::IfThenElseZero(known, read)));
    const auto floored = hn::Floor(hn::Sub(hn::Set(d64, 0.5), exact));
    const auto shift = hn::DemoteTo(di32, hn::Min(hn::Max(floored, hn::Neg(far)), far));
    // Not Iota(di32, x): only a constant start avoids a detour through memory.
    const auto column = hn::Add(hn::Iota(di32, 0), hn::Set(di32, block.begin + i));
    const auto target = hn::Min(hn::Max(hn::Add(column, shift), before), after);
    hn::StoreU(hn::IfThenElse(known, read, unknown), d32, block.disparity_px + 1 + i);
    hn::StoreU(hn::IfThenElse(hn::RebindMask(di32, known), target, before), di32,
               block.target + 1 + i);
  }
}

// Bit i: the sampling gap between column i and the column processed before it must be filled.
template <int kStep>
HWY_INLINE std::uint64_t find_gaps(float gradient_limit_px, const Block& block) {
  const hn::CappedTag<float, 16> d;
  const hn::RebindToSigned<decltype(d)> di;
  constexpr int kLanes = static_cast<int>(hn::MaxLanes(d));
  const auto limit = hn::Set(d, gradient_limit_px);
  const auto one = hn::Set(di, 1);
  std::uint64_t gaps = 0;
  for (int i = 0; i < block.count; i += kLanes) {
    const int here = 1 + i;
    const int previous = here - kStep;
    const auto target = hn::LoadU(di, block.target + here);
    const auto previous_target = hn::LoadU(di, block.target + previous);
    const auto distance =
        kStep > 0 ? hn::Sub(target, previous_target) : hn::Sub(previous_target, target);
    const auto rise = hn::Abs(hn::Sub(hn::LoadU(d, block.disparity_px + here),
                                      hn::LoadU(d, block.disparity_px + previous)));
    const auto is_gap = hn::And(hn::RebindMask(d, hn::Gt(distance, one)), hn::Le(rise, limit));
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(d, is_gap, bits);
    gaps |= (std::uint64_t{bits[0]} | std::uint64_t{bits[1]} << 8) << i;
  }
  return block.count < kBlock ? gaps & ((std::uint64_t{1} << block.count) - 1) : gaps;
}

// Columns that are written at once where they land side by side.
using Run = hn::CappedTag<float, 16>;
constexpr int kRun = static_cast<int>(hn::MaxLanes(Run()));

// Output of a pass; kColumns: whether source columns are requested.
template <bool kColumns>
struct Output {
  float* HWY_RESTRICT disparity_px;
  float* HWY_RESTRICT source_column;

  HWY_INLINE void write(int target, float disparity, float column) const {
    disparity_px[target] = disparity;
    if (kColumns) {
      source_column[target] = column;
    }
  }
};

// Fills the gap between column i of a block and its neighbour i − step.
template <bool kColumns>
HWY_NOINLINE void fill_sampling_gap(const ForwardWarpRow& row, const Block& block, int i, int step,
                                    Output<kColumns> output) {
  const int column = block.begin + i;
  const int previous_column = column - step;
  const float disparity_px = block.disparity_px[1 + i];
  const float previous_disparity_px = block.disparity_px[1 + i - step];
  const int target = block.target[1 + i];
  const int previous_target = block.target[1 + i - step];
  const double from = previous_column - row.camera_offset * previous_disparity_px;
  const double spacing = (column - row.camera_offset * disparity_px) - from;
  const double rise = double{disparity_px} - previous_disparity_px;
  const int end = std::max(previous_target, target);
  for (int n = std::min(previous_target, target) + 1; n < end; ++n) {
    const double fraction = (n - from) / spacing;
    output.write(n, static_cast<float>(previous_disparity_px + fraction * rise),
                 static_cast<float>(previous_column + fraction * (column - previous_column)));
  }
}

// Writes the columns of one vector if they land side by side, as on a smooth surface; else does
// nothing and returns false.
template <bool kColumns>
HWY_INLINE bool write_run(const Block& block, int first, int width, Output<kColumns> output) {
  const Run d;
  const hn::RebindToSigned<Run> di;
  const std::int32_t target = block.target[1 + first];
  const auto targets = hn::LoadU(di, block.target + 1 + first);
  if (target < 0 || target + kRun > width ||
      !hn::AllTrue(di, hn::Eq(targets, hn::Add(hn::Iota(di, 0), hn::Set(di, target))))) {
    return false;
  }
  hn::StoreU(hn::LoadU(d, block.disparity_px + 1 + first), d, output.disparity_px + target);
  if (kColumns) {
    const auto columns = hn::Add(hn::Iota(di, 0), hn::Set(di, block.begin + first));
    hn::StoreU(hn::ConvertTo(d, columns), d, output.source_column + target);
  }
  return true;
}

// Writes columns [first, end) of a block, in direction kStep.
template <int kStep, bool kColumns>
HWY_INLINE void write_columns(const Block& block, int first, int end, int width,
                              Output<kColumns> output) {
  const float* disparity_px = block.disparity_px + 1;
  const std::int32_t* target = block.target + 1;
  while (first < end) {
    const int count = std::min(kRun, end - first);
    const int run = kStep > 0 ? first : end - count;
    if (count < kRun || !write_run(block, run, width, output)) {
      for (int k = 0; k < count; ++k) {
        const int i = kStep > 0 ? run + k : run + count - 1 - k;
        if (HWY_LIKELY(static_cast<unsigned>(target[i]) < static_cast<unsigned>(width))) {
          output.write(target[i], disparity_px[i], static_cast<float>(block.begin + i));
        }
      }
    }
    (kStep > 0 ? first : end) += kStep > 0 ? count : -count;
  }
}

// Processes one scanline in direction kStep.
template <int kStep, bool kColumns>
HWY_INLINE void walk(const ForwardWarpRow& row, Output<kColumns> output) {
  const hn::ScalableTag<double> d64;
  const hn::CappedTag<double, 1> d64_one;
  HWY_ALIGN Block block = {};
  const int blocks = (row.width + kBlock - 1) / kBlock;
  float previous_disparity_px = std::numeric_limits<float>::quiet_NaN();
  std::int32_t previous_target = 0;
  for (int b = 0; b < blocks; ++b) {
    block.begin = (kStep > 0 ? b : blocks - 1 - b) * kBlock;
    block.count = std::min(kBlock, row.width - block.begin);
    const int whole_vectors = block.count - block.count % static_cast<int>(hn::Lanes(d64));
    find_targets(d64, row, 0, whole_vectors, block);
    find_targets(d64_one, row, whole_vectors, block.count - whole_vectors, block);
    const int previous = kStep > 0 ? 0 : block.count + 1;
    block.disparity_px[previous] = previous_disparity_px;
    block.target[previous] = previous_target;

    std::uint64_t gaps = find_gaps<kStep>(row.gradient_limit_px, block);
    int first = 0;
    int end = block.count;
    while (gaps != 0) {
      // Everything up to the gap, then the gap, because its column comes after it.
      if (kStep > 0) {
        const auto gap = static_cast<int>(hwy::Num0BitsBelowLS1Bit_Nonzero64(gaps));
        write_columns<kStep>(block, first, gap, row.width, output);
        fill_sampling_gap(row, block, gap, kStep, output);
        first = gap;
        gaps &= gaps - 1;
      } else {
        const auto gap = static_cast<int>(63 - hwy::Num0BitsAboveMS1Bit_Nonzero64(gaps));
        write_columns<kStep>(block, gap + 1, end, row.width, output);
        fill_sampling_gap(row, block, gap, kStep, output);
        end = gap + 1;
        gaps &= ~(std::uint64_t{1} << gap);
      }
    }
    write_columns<kStep>(block, first, end, row.width, output);
    const int last = kStep > 0 ? block.count : 1;
    previous_disparity_px = block.disparity_px[last];
    previous_target = block.target[last];
  }
}

template <bool kColumns>
HWY_INLINE void walk_either_way(const ForwardWarpRow& row, Output<kColumns> output) {
  if (row.camera_offset >= 0) {
    walk<1>(row, output);
  } else {
    walk<-1>(row, output);
  }
}

void forward_warp(const ForwardWarpRow& row, float* warped_disparity_px, float* source_column) {
  constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();
  std::fill_n(warped_disparity_px, row.width, kUnknown);
  if (source_column == nullptr) {
    walk_either_way(row, Output<false>{warped_disparity_px, nullptr});
  } else {
    std::fill_n(source_column, row.width, kUnknown);
    walk_either_way(row, Output<true>{warped_disparity_px, source_column});
  }
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vantage::kernels {
HWY_EXPORT(forward_warp);

void forward_warp_row(const ForwardWarpRow& row, float* warped_disparity_px, float* source_column) {
  HWY_DYNAMIC_DISPATCH(forward_warp)(row, warped_disparity_px, source_column);
}

}  // namespace vantage::kernels
#endif
