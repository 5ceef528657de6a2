#include "kernels/simd-inl.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "kernels/filled_median/filled_median.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {

using TagF = hn::ScalableTag<float>;
using TagI = hn::ScalableTag<std::int32_t>;
using Tag8 = hn::Repartition<std::uint8_t, TagI>;
using Vec = hn::VFromD<TagF>;
using VecI = hn::VFromD<TagI>;
constexpr int kStep = static_cast<int>(hn::MaxLanes(TagF()));
static_assert(kStep - 1 <= kFilledRowSlack);
constexpr int kSamples = kFilledMedianSamples * kFilledMedianSamples;
constexpr float kInfinity = std::numeric_limits<float>::infinity();

// Samples of the pixels of one group: [sample · kStep + lane]. Unused samples have weight
// 0 and are infinite, so they do not widen any bracket.
struct Samples {
  HWY_ALIGN float disparity_px[kSamples * kStep];
  HWY_ALIGN std::int32_t weight[kSamples * kStep];
};

// The median is one of the samples in [`min`, `max`]: samples below `min` have less than half
// of the total weight, samples up to `max` have at least half.
struct Brackets {
  Vec min, max;
  VecI total;  // weight of all samples
};

// The first column from x on whose pixel is unmatched (kIsUnmatched) or matched; `width` without
// one.
template <bool kIsUnmatched>
HWY_INLINE int find_column(const std::uint8_t* unmatched, int width, int x) {
  const hn::ScalableTag<std::uint8_t> d;
  constexpr int kBytes = static_cast<int>(hn::MaxLanes(d));
  for (; x + kBytes <= width; x += kBytes) {
    const auto matched = hn::Eq(hn::LoadU(d, unmatched + x), hn::Zero(d));
    const auto found = hn::FindFirstTrue(d, kIsUnmatched ? hn::Not(matched) : matched);
    if (found >= 0) {
      return x + static_cast<int>(found);
    }
  }
  for (; x < width && (unmatched[x] != 0) != kIsUnmatched; ++x) {
  }
  return x;
}

// Unmatched pixels of a row that fill a vector: runs of neighbours one after the other, because
// runs alone are shorter than vectors. Lanes after the last run are neighbours of its pixels, too.
class Group {
 public:
  // Takes the first unmatched pixels from column x on. Returns the column after them.
  int take(const std::uint8_t* unmatched, int width, int x) {
    runs_ = 0;
    lanes_ = 0;
    while (lanes_ < kStep) {
      const int first = find_column<true>(unmatched, width, x);
      if (first == width) {
        return width;
      }
      x = std::min(find_column<false>(unmatched, width, first), first + kStep - lanes_);
      add(first, x - first);
    }
    return x;
  }

  [[nodiscard]] bool empty() const { return runs_ == 0; }

  // The values at the group's pixels; `values` at column 0.
  [[nodiscard]] HWY_INLINE Vec load(const float* values) const {
    const TagF d;
    Vec loaded = hn::LoadU(d, values + offset_[0]);
    for (int run = 1; run < runs_; ++run) {
      loaded = hn::IfThenElse(from_[run], hn::LoadU(d, values + offset_[run]), loaded);
    }
    return loaded;
  }
  [[nodiscard]] HWY_INLINE VecI load_pixels(const std::uint8_t* pixels) const {
    const TagI d;
    const auto load_run = [&](int run) HWY_ATTR {
      return hn::BitCast(
          d, hn::LoadU(Tag8(), pixels + std::ptrdiff_t{kFilledPixelBytes} * offset_[run]));
    };
    VecI loaded = load_run(0);
    for (int run = 1; run < runs_; ++run) {
      loaded = hn::IfThenElse(hn::RebindMask(d, from_[run]), load_run(run), loaded);
    }
    return loaded;
  }
  // Stores the lanes whose `taken` is not 0.
  void store(const float* lanes, const std::int32_t* taken, float* values) const {
    for (int run = 0; run < runs_; ++run) {
      const int end = run + 1 < runs_ ? lane_[run + 1] : lanes_;
      for (int lane = lane_[run]; lane < end; ++lane) {
        if (taken[lane] != 0) {
          values[offset_[run] + lane] = lanes[lane];
        }
      }
    }
  }
  [[nodiscard]] hn::Mask<TagI> has_lanes() const {
    return hn::FirstN(TagI(), static_cast<std::size_t>(lanes_));
  }

 private:
  void add(int x, int columns) {
    const TagF d;
    offset_[runs_] = x - lanes_;
    lane_[runs_] = lanes_;
    from_[runs_] = hn::Not(hn::FirstN(d, static_cast<std::size_t>(lanes_)));
    ++runs_;
    lanes_ += columns;
  }

  int runs_ = 0;
  int lanes_ = 0;
  int lane_[kStep];               // first lane of each run
  std::ptrdiff_t offset_[kStep];  // its column less that lane
  hn::Mask<TagF> from_[kStep];    // its lanes and all after them
};

// Sums of absolute differences of channels.
HWY_INLINE VecI differences(VecI a, VecI b) {
  const TagI d;
  const Tag8 d8;
  const auto of_a = hn::BitCast(d8, a);
  const auto of_b = hn::BitCast(d8, b);
  // One of the two is 0.
  const VecI of_bytes =
      hn::BitCast(d, hn::Or(hn::SaturatedSub(of_a, of_b), hn::SaturatedSub(of_b, of_a)));
  const VecI every_other = hn::Set(d, 0x00FF00FF);
  const VecI of_pairs =
      hn::Add(hn::And(of_bytes, every_other), hn::And(hn::ShiftRight<8>(of_bytes), every_other));
  return hn::ShiftRight<16>(hn::Add(of_pairs, hn::ShiftLeft<16>(of_pairs)));
}

// filled_median_weights(), computed: that takes less time than looking up as many values as there
// are lanes. Exact, because no weight is so near to a half (3.5e-6 of its value) as the errors of
// this reach.
HWY_INLINE VecI weights_of(VecI differences) {
  const TagF d;
  const TagI di;
  constexpr auto kOctaves = static_cast<float>(-1.4426950408889634 / kFilledMedianLevels);
  // Sums with this have their integer part in the lowest bits.
  const Vec shift = hn::Set(d, 0x1.8p23F);
  const Vec octaves = hn::Mul(hn::ConvertTo(d, differences), hn::Set(d, kOctaves));
  const Vec shifted = hn::Add(octaves, shift);
  const Vec rest = hn::Sub(octaves, hn::Sub(shifted, shift));
  // 2^rest for |rest| ≤ 0.5, relative error 2e-7, in steps of a weight.
  Vec power = hn::Set(d, 1.339086336e-03F * kFilledUnitWeight);
  for (const float coefficient :
       {9.676031918e-03F * kFilledUnitWeight, 5.550357114e-02F * kFilledUnitWeight,
        2.402210749e-01F * kFilledUnitWeight, 6.931471880e-01F * kFilledUnitWeight,
        1.000000075e+00F * kFilledUnitWeight}) {
    power = hn::MulAdd(power, rest, hn::Set(d, coefficient));
  }
  const Vec weight =
      hn::BitCast(d, hn::Add(hn::BitCast(di, power), hn::ShiftLeft<23>(hn::BitCast(di, shifted))));
  return hn::Sub(hn::BitCast(di, hn::Add(weight, shift)), hn::BitCast(di, shift));
}

HWY_INLINE Brackets take_samples(const FilledRow& row, const Group& group, Samples& samples) {
  const TagF d;
  const TagI di;
  const VecI own = group.load_pixels(row.pixels);
  const Vec infinity = hn::Set(d, kInfinity);
  Brackets brackets{infinity, hn::Neg(infinity), hn::Zero(di)};
  float* sample_px = samples.disparity_px;
  std::int32_t* sample_weight = samples.weight;
  for (int j = -row.grid.count / 2; j <= row.grid.count / 2; ++j) {
    const std::ptrdiff_t dy = j * row.grid.step_px;
    const float* row_px = row.disparity_px + dy * row.disparity_pitch;
    const std::uint8_t* row_pixels = row.pixels + dy * row.pixel_pitch;
    for (int i = -row.grid.count / 2; i <= row.grid.count / 2; ++i) {
      const std::ptrdiff_t dx = i * row.grid.step_px;
      const Vec disparity_px = group.load(row_px + dx);
      const auto is_known = hn::RebindMask(di, hn::Eq(disparity_px, disparity_px));
      const VecI unlike = differences(group.load_pixels(row_pixels + dx * kFilledPixelBytes), own);
      const VecI weight = hn::IfThenElseZero(is_known, weights_of(unlike));
      const auto counts = hn::RebindMask(d, hn::Gt(weight, hn::Zero(di)));
      const Vec counted_px = hn::IfThenElse(counts, disparity_px, infinity);
      brackets.min = hn::Min(brackets.min, counted_px);
      brackets.max = hn::Max(brackets.max, hn::IfThenElse(counts, disparity_px, hn::Neg(infinity)));
      brackets.total = hn::Add(brackets.total, weight);
      hn::Store(counted_px, d, sample_px);
      hn::Store(weight, di, sample_weight);
      sample_px += kStep;
      sample_weight += kStep;
    }
  }
  return brackets;
}

// Removes the samples on the wrong side of `pivots`. Pivots in [`min`, `max`) remove at least
// one.
HWY_INLINE void narrow(const Samples& samples, int count, Vec pivots, Brackets& brackets) {
  const TagF d;
  const TagI di;
  const Vec infinity = hn::Set(d, kInfinity);
  VecI weight = hn::Zero(di);
  Vec max_below = hn::Neg(infinity);
  Vec min_above = infinity;
  for (int i = 0; i < count * kStep; i += kStep) {
    const Vec disparity_px = hn::Load(d, samples.disparity_px + i);
    const auto is_below = hn::Le(disparity_px, pivots);
    weight = hn::Add(
        weight, hn::IfThenElseZero(hn::RebindMask(di, is_below), hn::Load(di, samples.weight + i)));
    max_below = hn::Max(max_below, hn::IfThenElse(is_below, disparity_px, hn::Neg(infinity)));
    min_above = hn::Min(min_above, hn::IfThenElse(is_below, infinity, disparity_px));
  }
  const auto is_above = hn::RebindMask(d, hn::Lt(hn::Add(weight, weight), brackets.total));
  brackets.min = hn::IfThenElse(is_above, min_above, brackets.min);
  brackets.max = hn::IfThenElse(is_above, brackets.max, max_below);
}

void take_filled_medians_simd(const FilledRow& row, float* filled_px) {
  const TagF d;
  const TagI di;
  const Vec half = hn::Set(d, 0.5F);
  const int count = row.grid.count * row.grid.count;
  Samples samples;
  Group group;
  HWY_ALIGN std::int32_t taken[kStep];
  HWY_ALIGN float medians_px[kStep];
  for (int x = group.take(row.unmatched, row.width, 0); !group.empty();
       x = group.take(row.unmatched, row.width, x)) {
    Brackets brackets = take_samples(row, group, samples);
    const auto is_taken = hn::And(group.has_lanes(), hn::Gt(brackets.total, hn::Zero(di)));
    // Pixels that keep their values need no search.
    brackets.max = hn::IfThenElse(hn::RebindMask(d, is_taken), brackets.max, brackets.min);
    while (!hn::AllFalse(d, hn::Lt(brackets.min, brackets.max))) {
      const Vec middle = hn::Add(hn::Mul(brackets.min, half), hn::Mul(brackets.max, half));
      // If there is no float in between, the pivot is the smallest sample: that removes it or all
      // others.
      const auto is_between = hn::And(hn::Ge(middle, brackets.min), hn::Lt(middle, brackets.max));
      narrow(samples, count, hn::IfThenElse(is_between, middle, brackets.min), brackets);
    }
    hn::Store(hn::VecFromMask(di, is_taken), di, taken);
    // The addition turns −0 into 0.
    hn::Store(hn::Add(brackets.max, hn::Zero(d)), d, medians_px);
    group.store(medians_px, taken, filled_px);
  }
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vantage::kernels {
HWY_EXPORT(take_filled_medians_simd);

void take_filled_medians_row(const FilledRow& row, float* filled_px) {
  HWY_DYNAMIC_DISPATCH(take_filled_medians_simd)(row, filled_px);
}

static FilledMedianWeights make_weights() {
  FilledMedianWeights weights{};
  for (std::size_t sum = 0; sum < weights.size(); ++sum) {
    weights[sum] = static_cast<std::int32_t>(
        std::lround(kFilledUnitWeight * std::exp(-static_cast<double>(sum) / kFilledMedianLevels)));
  }
  return weights;
}

const FilledMedianWeights& filled_median_weights() {
  static const FilledMedianWeights weights = make_weights();
  return weights;
}

}  // namespace vantage::kernels
#endif
