#pragma once

#include <vector>

namespace vantage {

/// Whole numbers from 1 to `most` (≥ 1), both included, each about one and a half times the one
/// before.
std::vector<int> coarse_ladder(int most);

/// Whole numbers within [1, most] around `value`: the next ones, and a sixth and a third away.
/// Without `value` itself.
std::vector<int> fine_ladder(int value, int most);

}  // namespace vantage
