#include "engine/combinations/option_values.h"

#include <fmt/format.h>

namespace vantage {

std::string OptionValues::Value::text() const {
  return word.empty() ? fmt::format("{}", number) : word;
}

void OptionValues::take(const OptionValues& others) {
  for (const auto& [option, value] : others.values_) {
    const Value* const before = find(option);
    const bool is_set = before == nullptr ? value.is_set : before->is_set;
    values_[option] = {value.number, value.word, is_set, true};
  }
  chosen = others.chosen;
}

}  // namespace vantage
