#include "engine/sequence/pairs/sequence_range.h"

#include <algorithm>

#include "engine/error.h"

namespace vantage {
namespace {

/// Estimating the range of a pair takes an eighth of its matching time: little compared with a long
/// sequence, and at most that of a single pair for a short one.
constexpr int kMaxPairs = 16;

std::optional<DisparityRange> range_of_pair(PairSource& pairs, int index,
                                            const PreparePair& prepare, FramePair& pair,
                                            Execution& execution, Infinity infinity) {
  try {
    pairs.skip_to(index);
    if (!pairs.fetch(pair)) {
      return std::nullopt;
    }
    pairs.decode(pair);
    if (prepare) {
      prepare(pair);
    }
    return find_disparity_range(pair.left, pair.right, execution, {0, 0}, infinity);
  } catch (const Error&) {
    return std::nullopt;  // the run itself reports bad frames
  }
}

}  // namespace

std::optional<DisparityRange> find_sequence_range(PairSource& pairs, const PreparePair& prepare,
                                                  Execution& execution, Infinity infinity,
                                                  const std::function<void(int, int)>& progress) {
  const FrameRange all = pairs.repeatable_pairs();
  const int count = std::min(all.count(), kMaxPairs);
  std::optional<DisparityRange> together;
  FramePair pair;
  for (int i = 0; i < count; ++i) {
    const auto index = all.first + (count == 1 ? 0
                                               : static_cast<int>(static_cast<long long>(i) *
                                                                  (all.count() - 1) / (count - 1)));
    if (const auto range = range_of_pair(pairs, index, prepare, pair, execution, infinity)) {
      together = together ? DisparityRange{std::min(together->min, range->min),
                                           std::max(together->max, range->max)}
                          : *range;
    }
    if (progress) {
      progress(i + 1, count);
    }
  }
  pairs.skip_to(all.first);
  return together;
}

}  // namespace vantage
