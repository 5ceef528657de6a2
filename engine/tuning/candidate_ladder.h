#pragma once

#include <vector>

namespace vantage {

/// Integers from 1 to `max` (≥ 1), inclusive, each about one and a half times the previous one.
std::vector<int> coarse_ladder(int max);

/// Integers within [1, most] around `value`: the adjacent ones, and a sixth and a third away.
/// Without `value` itself.
std::vector<int> fine_ladder(int value, int max);

}  // namespace vantage
