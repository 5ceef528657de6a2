#pragma once

#include "engine/matching/aggregation/aggregation_table.h"
#include "engine/matching/costs/cost_table.h"
#include "tests/engine/engine_test.h"

namespace vantage {
inline namespace test {

/// The keys of a table's entries for which `holds`.
template <typename Table, typename Holds>
auto keys_in(const Table& table, const Holds& holds) {
  std::vector<decltype(table.begin()->key)> keys;
  for (const auto& entry : table) {
    if (holds(entry)) {
      keys.push_back(entry.key);
    }
  }
  return keys;
}

inline std::vector<MatchCost> all_costs() {
  return keys_in(cost_table(), [](const MatchingCost&) { return true; });
}
inline std::vector<Aggregation> all_aggregations() {
  return keys_in(aggregation_table(), [](const CellAggregation&) { return true; });
}

}  // namespace test
}  // namespace vantage
