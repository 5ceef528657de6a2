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

/// The disparity range to search in all pairs of a sequence: the union of find_disparity_range()
/// over up to 16 of them, evenly spaced from the first to the last; of a stream over the first
/// ones, PairSource::repeatable_pairs(). It depends on the whole input alone, so that parts of a
/// run and resumed runs agree. Pairs that cannot be read, or give no range, are ignored. Empty if
/// none gives one. `prepare` may be empty, and `progress`, which is told how many of how many pairs
/// were searched. Afterwards the source is at the first pair. Identical for any `execution`.
std::optional<DisparityRange> find_sequence_range(
    PairSource& pairs, const PreparePair& prepare, Execution& execution,
    Infinity infinity = Infinity::kAtZero, const std::function<void(int, int)>& progress = {});

}  // namespace vantage
