#include "engine/combinations/combination_texts.h"

#include <algorithm>

namespace vantage {
namespace {

/// "save" of "save views".
std::string_view name_of(const Condition& condition) {
  return std::string_view(condition.option).substr(0, condition.option.find(' '));
}

/// Whether the rules of `scope` are those of a command with these options.
bool applies(CombinationScope scope, const std::function<bool(std::string_view)>& is_known) {
  switch (scope) {
    case CombinationScope::kMethod:
    case CombinationScope::kMatch:
      return true;
    case CombinationScope::kReuse:
    case CombinationScope::kSequence:
    case CombinationScope::kPairList:
    case CombinationScope::kJob:
    case CombinationScope::kRun:
      return is_known("save");
    case CombinationScope::kMatchJob:
      return is_known("unmatched-right");
  }
  return true;
}

}  // namespace

std::vector<std::string> not_with(std::string_view option,
                                  const std::function<bool(std::string_view)>& is_known) {
  std::vector<std::string> texts;
  const auto add = [&](const Condition& other) {
    if (!is_known(name_of(other)) || name_of(other) == option) {
      return;
    }
    std::string text = other.text();
    if (std::ranges::find(texts, text) == texts.end()) {
      texts.push_back(std::move(text));
    }
  };
  for (const Combination& row : combinations()) {
    const bool is_refused =
        !row.message.empty() && applies(row.scope, is_known) && is_known(name_of(row.option));
    for (const Condition& with : row.with) {
      if (is_refused && name_of(row.option) == option) {
        add(with);
      } else if (is_refused && name_of(with) == option) {
        add(row.option);
      }
    }
  }
  return texts;
}

}  // namespace vantage
