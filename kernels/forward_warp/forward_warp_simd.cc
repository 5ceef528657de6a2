#include "kernels/simd-inl.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernels/forward_warp/forward_warp.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {

// Columns whose targets are computed at a time, and then read: so many that most of them are in the
// cache by then, since vectors that other vectors have just been stored across wait for it.
constexpr int kBlock = 256;
constexpr int kWord = 64;
// Farther than any row width, and safe to convert and to add to a column.
constexpr double kFarColumns = 1 << 29;

// Neighbouring columns plus one on each side: the end columns of the adjacent blocks.
struct Block {
  int begin = 0;  // column of element 1
  int count = 0;
  float disparity_px[kBlock + 18];  // NaN = unknown; read in whole vectors
  std::int32_t target[kBlock + 2];  // −1 and width represent everything outside the view
};

// Columns processed at once.
using Columns = hn::CappedTag<float, 16>;
using Targets = hn::RebindToSigned<Columns>;
constexpr int kLanes = static_cast<int>(hn::MaxLanes(Columns()));

// floor(x − s·d + ½) for the columns of a block, in double as in every other way to a place.
// Reads and writes whole vectors.
HWY_INLINE void find_targets(const ForwardWarpRow& row, const float* HWY_RESTRICT disparity_px,
                             Block& block) {
  const hn::CappedTag<double, 8> d64;
  const hn::Rebind<float, decltype(d64)> d32;
  const hn::Rebind<std::int32_t, decltype(d64)> di32;
  const auto largest = hn::Set(d32, std::numeric_limits<float>::max());
  const auto unknown = hn::Set(d32, std::numeric_limits<float>::quiet_NaN());
  const auto offset = hn::Set(d64, row.camera_offset);
  const auto far = hn::Set(d64, kFarColumns);
  const auto before = hn::Set(di32, -1);
  const auto after = hn::Set(di32, row.width);
  const auto lane = hn::Iota(di32, 0);
  for (int i = 0; i < block.count; i += static_cast<int>(hn::MaxLanes(d64))) {
    const auto read = hn::LoadU(d32, disparity_px + i);
    const auto known = hn::Le(hn::Abs(read), largest);
    const auto exact = hn::Mul(offset, hn::PromoteTo(d64, hn::IfThenElseZero(known, read)));
    const auto floored = hn::Floor(hn::Sub(hn::Set(d64, 0.5), exact));
    const auto shift = hn::DemoteTo(di32, hn::Min(hn::Max(floored, hn::Neg(far)), far));
    const auto column = hn::Add(lane, hn::Set(di32, block.begin + i));
    const auto target = hn::Min(hn::Max(hn::Add(column, shift), before), after);
    hn::StoreU(hn::IfThenElse(known, read, unknown), d32, block.disparity_px + 1 + i);
    hn::StoreU(hn::IfThenElse(hn::RebindMask(di32, known), target, before), di32,
               block.target + 1 + i);
  }
}

// A bit per column of 64 of a block: how it lands after the one that is processed before it.
struct WordBits {
  std::uint64_t gaps = 0;    // a sampling gap between them is filled
  std::uint64_t breaks = 0;  // not beside it
};

// Bits of `count` columns of a block from `first` on.
template <int kStep>
HWY_INLINE WordBits find_bits(float gradient_limit_px, const Block& block, int first, int count) {
  const Columns d;
  const Targets di;
  const auto limit = hn::Set(d, gradient_limit_px);
  const auto one = hn::Set(di, 1);
  const auto bits_of = [d](hn::Mask<Columns> mask) HWY_ATTR {
    std::uint64_t bits = 0;  // little-endian
    hn::StoreMaskBits(d, mask, reinterpret_cast<std::uint8_t*>(&bits));
    return bits;
  };
  WordBits found;
  for (int i = 0; i < count; i += kLanes) {
    const int here = 1 + first + i;
    const int previous = here - kStep;
    const auto target = hn::LoadU(di, block.target + here);
    const auto previous_target = hn::LoadU(di, block.target + previous);
    const auto distance =
        kStep > 0 ? hn::Sub(target, previous_target) : hn::Sub(previous_target, target);
    const auto rise = hn::Abs(hn::Sub(hn::LoadU(d, block.disparity_px + here),
                                      hn::LoadU(d, block.disparity_px + previous)));
    found.gaps |= bits_of(hn::And(hn::RebindMask(d, hn::Gt(distance, one)), hn::Le(rise, limit)))
                  << i;
    found.breaks |= bits_of(hn::RebindMask(d, hn::Ne(distance, one))) << i;
  }
  const std::uint64_t all = ~std::uint64_t{0} >> (kWord - count);
  const std::uint64_t processed_first = std::uint64_t{1} << (kStep > 0 ? 0 : count - 1);
  return {found.gaps & all, (found.breaks & all) | processed_first};
}

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

// Writes columns [first, end) of a block, which land side by side.
template <bool kColumns>
HWY_INLINE void write_run(const Block& block, int first, int end, int width,
                          Output<kColumns> output) {
  const Columns d;
  const Targets di;
  first += block.target[1 + first] < 0 ? 1 : 0;
  const int shift = block.target[1 + first] - first;
  end = std::min(end, width - shift);
  if (first >= end) {
    return;
  }
  const auto write = [&](int i, auto store) HWY_ATTR {
    store(hn::LoadU(d, block.disparity_px + 1 + i), output.disparity_px + shift + i);
    if (kColumns) {
      const auto columns = hn::Add(hn::Iota(di, 0), hn::Set(di, block.begin + i));
      store(hn::ConvertTo(d, columns), output.source_column + shift + i);
    }
  };
  int i = first;
  for (; i + kLanes <= end; i += kLanes) {
    write(i, [](auto values, float* to) HWY_ATTR { hn::StoreU(values, Columns(), to); });
  }
  if constexpr (kLanes == 16) {  // there, stores of a part are as fast
    const auto rest = hn::FirstN(d, static_cast<std::size_t>(end - i));
    write(i, [rest](auto values, float* to)
                 HWY_ATTR { hn::BlendedStore(values, rest, Columns(), to); });
  } else {
    for (; i < end; ++i) {
      output.write(shift + i, block.disparity_px[1 + i], static_cast<float>(block.begin + i));
    }
  }
}

// Processes `count` columns of a block from `word` on, in direction kStep.
template <int kStep, bool kColumns>
HWY_INLINE void write_word(const ForwardWarpRow& row, const Block& block, int word, int count,
                           Output<kColumns> output) {
  const WordBits bits = find_bits<kStep>(row.gradient_limit_px, block, word, count);
  const auto fill_gap_before = [&](int i) HWY_ATTR {
    if ((bits.gaps >> i & 1U) != 0) {
      fill_sampling_gap(row, block, word + i, kStep, output);
    }
  };
  std::uint64_t breaks = bits.breaks;
  while (breaks != 0) {
    if (kStep > 0) {
      const auto first = static_cast<int>(hwy::Num0BitsBelowLS1Bit_Nonzero64(breaks));
      breaks &= breaks - 1;
      const int end =
          breaks != 0 ? static_cast<int>(hwy::Num0BitsBelowLS1Bit_Nonzero64(breaks)) : count;
      fill_gap_before(first);
      write_run(block, word + first, word + end, row.width, output);
    } else {
      const auto last = static_cast<int>(63 - hwy::Num0BitsAboveMS1Bit_Nonzero64(breaks));
      breaks &= ~(std::uint64_t{1} << last);
      const int before =
          breaks != 0 ? static_cast<int>(63 - hwy::Num0BitsAboveMS1Bit_Nonzero64(breaks)) : -1;
      fill_gap_before(last);
      write_run(block, word + before + 1, word + last + 1, row.width, output);
    }
  }
}

// Processes one scanline in direction kStep.
template <int kStep, bool kColumns>
HWY_INLINE void walk(const ForwardWarpRow& row, Output<kColumns> output) {
  HWY_ALIGN Block block = {};
  HWY_ALIGN float last_disparity_px[kBlock] = {};  // of a block that is not whole
  const int blocks = (row.width + kBlock - 1) / kBlock;
  float previous_disparity_px = std::numeric_limits<float>::quiet_NaN();
  std::int32_t previous_target = 0;
  for (int b = 0; b < blocks; ++b) {
    block.begin = (kStep > 0 ? b : blocks - 1 - b) * kBlock;
    block.count = std::min(kBlock, row.width - block.begin);
    const float* disparity_px = row.disparity_px + block.begin;
    if (block.count < kBlock) {
      std::copy_n(disparity_px, block.count, last_disparity_px);
      disparity_px = last_disparity_px;
    }
    find_targets(row, disparity_px, block);
    const int previous = kStep > 0 ? 0 : block.count + 1;
    block.disparity_px[previous] = previous_disparity_px;
    block.target[previous] = previous_target;

    for (int i = 0; i < block.count; i += kWord) {
      const int word = kStep > 0 ? i : (block.count - 1) / kWord * kWord - i;
      const int count = std::min(kWord, block.count - word);
      write_word<kStep>(row, block, word, count, output);
    }
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
