#pragma once

#include <functional>
#include <optional>

#include "engine/execution.h"
#include "engine/matching/options/match_options.h"
#include "engine/matching/range_estimation.h"
#include "engine/sequence/pairs/pair_source.h"

namespace vantage {

/// Preparation of a pair for matching, such as rectification.
using PreparePair = std::function<void(FramePair&)>;

/// Estimating the range of a pair takes an eighth of its matching time: little compared with a long
/// sequence, and at most that of a single pair for a short one.
inline constexpr int kMaxSampledPairs = 16;

/// Calls `visit` with up to `max_pairs` pairs of a sequence, evenly spaced from the first to the
/// last; of a stream the first ones, PairSource::repeatable_pairs(), which it waits for. They
/// depend on the whole input alone, so that parts of a run and resumed runs agree. Pairs that
/// cannot be read, or whose visit throws Error, are ignored: the run itself reports them.
/// `progress` is told how many of how many pairs were visited; it may be empty. Afterwards the
/// source is at the first pair.
void visit_sampled_pairs(PairSource& pairs, const PreparePair& visit,
                         const std::function<void(int, int)>& progress = {},
                         int max_pairs = kMaxSampledPairs);

/// The disparity range to search in all pairs of a sequence: the union of find_disparity_range()
/// over those of visit_sampled_pairs(). Pairs that give no range are ignored. Empty if none gives
/// one. `prepare` may be empty. Identical for any `execution`.
std::optional<DisparityRange> find_sequence_range(
    PairSource& pairs, const PreparePair& prepare, Execution& execution,
    Infinity infinity = Infinity::kAtZero, const std::function<void(int, int)>& progress = {});

}  // namespace vantage
