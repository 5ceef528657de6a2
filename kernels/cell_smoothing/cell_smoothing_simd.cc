#include "kernels/simd-inl.h"

#include <algorithm>
#include <cstddef>

#include "kernels/candidates.h"
#include "kernels/cell_smoothing/cell_smoothing.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {

using Tag = hn::ScalableTag<float>;
using Vec = hn::VFromD<Tag>;

// Computes kVectors vectors of the sum.
template <int kVectors>
HWY_INLINE void sum_block(const SymmetricSum& sum, std::ptrdiff_t first, float* output) {
  const Tag d;
  constexpr std::ptrdiff_t step = static_cast<std::ptrdiff_t>(hn::MaxLanes(d));
  const int radius = sum.radius;
  const float* const weights = sum.weights;
  const float* const* const middle = sum.runs + radius;
  Vec sums[kVectors];
  const Vec middle_weight = hn::Set(d, weights[0]);
#pragma GCC unroll 4
  for (int v = 0; v < kVectors; ++v) {
    sums[v] = hn::Mul(middle_weight, hn::LoadU(d, middle[0] + first + v * step));
  }
  for (int k = 1; k <= radius; ++k) {
    const float* const before = middle[-k];
    const float* const after = middle[k];
    const Vec weight = hn::Set(d, weights[k]);
    if (before != nullptr && after != nullptr) {
#pragma GCC unroll 4
      for (int v = 0; v < kVectors; ++v) {
        const Vec pair = hn::Add(hn::LoadU(d, before + first + v * step),
                                 hn::LoadU(d, after + first + v * step));
        sums[v] = hn::Add(sums[v], hn::Mul(weight, pair));
      }
    } else if (const float* present = before != nullptr ? before : after; present != nullptr) {
#pragma GCC unroll 4
      for (int v = 0; v < kVectors; ++v) {
        sums[v] = hn::Add(sums[v], hn::Mul(weight, hn::LoadU(d, present + first + v * step)));
      }
    }
  }
#pragma GCC unroll 4
  for (int v = 0; v < kVectors; ++v) {
    hn::StoreU(sums[v], d, output + first + v * step);
  }
}

void sum_runs(const SymmetricSum& sum, float* output) {
  constexpr std::ptrdiff_t step = static_cast<std::ptrdiff_t>(hn::MaxLanes(Tag()));
  const std::ptrdiff_t count = sum.count;
  std::ptrdiff_t i = 0;
  for (; i + 4 * step <= count; i += 4 * step) {
    sum_block<4>(sum, i, output);
  }
  for (; i < count; i += step) {
    sum_block<1>(sum, i, output);
  }
}

// State of the four boxes along a row, column by column. A box of three is the sum of the previous
// two columns and the new one; a box of five is the sum of the newest two and the previous three.
class BoxesAlong {
 public:
  HWY_INLINE BoxesAlong()
      : before_(hn::Zero(Tag())),
        two_before_(before_),
        three_before_(before_),
        three_2_before_(before_) {}
  // Returns the result kRadius columns before `cell`, once 2 · kRadius columns were added.
  HWY_INLINE Vec add(Vec cell) {
    const Vec third = third_.add(second_.add(first_.add(cell)));
    const Vec two = hn::Add(third, before_);
    const Vec five = hn::Add(two, three_2_before_);
    three_2_before_ = three_before_;
    three_before_ = hn::Add(two, two_before_);
    two_before_ = before_;
    before_ = third;
    return five;
  }

 private:
  class BoxOfThree {
   public:
    HWY_INLINE BoxOfThree() : before_(hn::Zero(Tag())), two_(before_) {}
    HWY_INLINE Vec add(Vec cell) {
      const Vec three = hn::Add(two_, cell);
      two_ = hn::Add(before_, cell);
      before_ = cell;
      return three;
    }

   private:
    Vec before_;
    Vec two_;
  };

  BoxOfThree first_;
  BoxOfThree second_;
  BoxOfThree third_;
  Vec before_;
  Vec two_before_;
  Vec three_before_;
  Vec three_2_before_;
};

// Processes one vector of neighbouring lanes over all columns. down(k) is the sum over rows at
// column input_begin + k.
template <typename Down>
HWY_INLINE void cascade_lanes(const BoxCascade& cascade, const Down& down, float* output) {
  const Tag d;
  constexpr int kRadius = BoxCascade::kRadius;
  const std::ptrdiff_t lanes = cascade.lanes;
  const Vec unit_gain = hn::Set(d, BoxCascade::kUnitGain);
  BoxesAlong boxes;
  const int window_end = cascade.output_begin + kRadius;
  const int inner_end = std::min(cascade.input_end, cascade.output_end + kRadius);
  int x = cascade.output_begin - kRadius;
  for (; x < std::min(cascade.input_begin, window_end); ++x) {
    boxes.add(hn::Zero(d));
  }
  for (; x < std::min(inner_end, window_end); ++x) {
    boxes.add(down(x - cascade.input_begin));
  }
  for (; x < window_end; ++x) {
    boxes.add(hn::Zero(d));
  }
  for (; x < inner_end; ++x, output += lanes) {
    hn::StoreU(hn::Mul(boxes.add(down(x - cascade.input_begin)), unit_gain), d, output);
  }
  for (; x < cascade.output_end + kRadius; ++x, output += lanes) {
    hn::StoreU(hn::Mul(boxes.add(hn::Zero(d)), unit_gain), d, output);
  }
}

// Both directions in one pass: sums over the rows stay in registers.
HWY_INLINE void cascade_in_registers(const BoxCascade& cascade, float* output) {
  const Tag d;
  constexpr int kRadius = BoxCascade::kRadius;
  constexpr int step = static_cast<int>(hn::MaxLanes(d));
  const std::ptrdiff_t lanes = cascade.lanes;
  // Constants after unrolling, so that all stay in registers.
  Vec weights[kRadius];
#pragma GCC unroll 5
  for (int k = 0; k < kRadius; ++k) {
    weights[k] = hn::Set(d, BoxCascade::kWeights[k]);
  }
  for (int lane = 0; lane < cascade.lanes; lane += step) {
    const float* rows[2 * kRadius + 1];
#pragma GCC unroll 11
    for (int k = 0; k <= 2 * kRadius; ++k) {
      rows[k] = cascade.rows[k] + lane;
    }
    const auto down = [&](int column) HWY_ATTR {
      const std::ptrdiff_t cell = column * lanes;
      Vec sum = hn::Mul(weights[0], hn::LoadU(d, rows[kRadius] + cell));
#pragma GCC unroll 4
      for (int k = 1; k < kRadius; ++k) {
        const Vec pair =
            hn::Add(hn::LoadU(d, rows[kRadius - k] + cell), hn::LoadU(d, rows[kRadius + k] + cell));
        sum = hn::Add(sum, hn::Mul(weights[k], pair));
      }
      return hn::Add(sum, hn::Add(hn::LoadU(d, rows[0] + cell),  // weight 1
                                  hn::LoadU(d, rows[2 * kRadius] + cell)));
    };
    cascade_lanes(cascade, down, output + lane);
  }
}

void cascade_row(const BoxCascade& cascade, float* work, float* output) {
  const Tag d;
  constexpr int step = static_cast<int>(hn::MaxLanes(d));
  // Where a vector is a cache line and there are enough registers for both directions.
  if constexpr (step == kLaneMultiple) {
    const float* const* const rows_end = cascade.rows + 2 * BoxCascade::kRadius + 1;
    if (std::find(cascade.rows, rows_end, nullptr) == rows_end) {
      cascade_in_registers(cascade, output);
      return;
    }
  }
  const std::ptrdiff_t lanes = cascade.lanes;
  sum_runs({cascade.rows, BoxCascade::kWeights.data(), BoxCascade::kRadius,
            (cascade.input_end - cascade.input_begin) * cascade.lanes},
           work);
  for (int lane = 0; lane < cascade.lanes; lane += step) {
    const auto down = [&](int column)
                          HWY_ATTR { return hn::LoadU(d, work + column * lanes + lane); };
    cascade_lanes(cascade, down, output + lane);
  }
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vantage::kernels {
HWY_EXPORT(sum_runs);
HWY_EXPORT(cascade_row);

void symmetric_sum(const SymmetricSum& sum, float* output) {
  HWY_DYNAMIC_DISPATCH(sum_runs)(sum, output);
}
void box_cascade_row(const BoxCascade& cascade, float* work, float* output) {
  HWY_DYNAMIC_DISPATCH(cascade_row)(cascade, work, output);
}

}  // namespace vantage::kernels
#endif
