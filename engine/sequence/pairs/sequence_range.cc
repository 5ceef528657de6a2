#include "engine/sequence/pairs/sequence_range.h"

#include <algorithm>

#include "engine/error.h"

namespace vantage {

void visit_sampled_pairs(PairSource& pairs, const PreparePair& visit,
                         const std::function<void(int, int)>& progress, int max_pairs) {
  const FrameRange all = pairs.repeatable_pairs();
  const int count = std::min(all.count(), max_pairs);
  FramePair pair;
  for (int i = 0; i < count; ++i) {
    const auto index = all.first + (count == 1 ? 0
                                               : static_cast<int>(static_cast<long long>(i) *
                                                                  (all.count() - 1) / (count - 1)));
    try {
      pairs.skip_to(index);
      if (pairs.fetch(pair)) {
        pairs.decode(pair);
        visit(pair);
      }
    } catch (const Error&) {
      // The run itself reports bad frames.
    }
    if (progress) {
      progress(i + 1, count);
    }
  }
  pairs.skip_to(all.first);
}

std::optional<DisparityRange> find_sequence_range(PairSource& pairs, const PreparePair& prepare,
                                                  Execution& execution, Infinity infinity,
                                                  const std::function<void(int, int)>& progress) {
  std::optional<DisparityRange> together;
  const auto widen = [&](FramePair& pair) {
    if (prepare) {
      prepare(pair);
    }
    if (const auto range =
            find_disparity_range(pair.left, pair.right, execution, {0, 0}, infinity)) {
      together = together ? DisparityRange{std::min(together->min, range->min),
                                           std::max(together->max, range->max)}
                          : *range;
    }
  };
  visit_sampled_pairs(pairs, widen, progress);
  return together;
}

}  // namespace vantage
