#include "engine/matching/options/parameter_readers.h"

#include <fmt/format.h>

#include <vector>

#include "engine/matching/aggregation/aggregation_table.h"
#include "engine/matching/costs/cost_table.h"
#include "engine/word_list.h"

namespace vantage {
namespace {

/// Names of the entries that read an option.
template <typename Table>
std::vector<std::string_view> names_in(const Table& table, std::string_view option) {
  std::vector<std::string_view> names;
  for (const auto& entry : table) {
    if (entry.reads(option)) {
      names.push_back(entry.name);
    }
  }
  return names;
}

/// "cost census", "costs census and gradient".
std::string counted(std::string_view noun, const std::vector<std::string_view>& names) {
  return fmt::format("{}{} {}", noun, names.size() == 1 ? "" : "s", word_list(names, "and"));
}

}  // namespace

std::string names_of(const ParameterReaders& readers, std::string_view option) {
  const auto costs = names_in(cost_table(), option);
  const auto aggregations = names_in(aggregation_table(), option);
  return fmt::format(fmt::runtime(readers.text), fmt::arg("costs", counted("cost", costs)),
                     fmt::arg("names", word_list(aggregations, "and")),
                     fmt::arg("aggregations", counted("aggregation", aggregations)));
}

bool reads(const MethodParameters& parameters, std::string_view option) {
  return cost_of(parameters).reads(option) || aggregation_of(parameters).reads(option);
}

}  // namespace vantage
