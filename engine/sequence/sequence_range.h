#pragma once

#include <functional>
#include <optional>

#include "engine/execution.h"
#include "engine/matching/options/match_options.h"
#include "engine/sequence/pair_source.h"

namespace vantage {

/// What is done to a pair ahead of matching, such as rectifying it.
using PreparePair = std::function<void(FramePair&)>;

/// The range of disparities to search in all pairs of a sequence: what find_disparity_range() says
/// of up to 16 of them, spread evenly from the first to the last, taken together. It depends on the
/// whole input alone, so that parts of a run and runs that go on agree. Pairs that cannot be read
/// are passed over, and those that give no evidence. None where none does. `prepare` may be empty.
/// The source stands at pair 0 afterwards. Identical for any `execution`.
std::optional<DisparityRange> find_sequence_range(PairSource& pairs, const PreparePair& prepare,
                                                  Execution& execution);

}  // namespace vantage
