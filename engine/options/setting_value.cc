#include "engine/options/setting_value.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>

#include "engine/error.h"
#include "engine/io/files/json_text.h"

namespace vantage {
namespace {

template <typename T>
std::optional<T> parse(std::string_view text) {
  if (!text.empty() && text.front() == '+') {
    text.remove_prefix(1);
  }
  T result{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), result);
  if (error != std::errc{} || end != text.data() + text.size()) {
    return std::nullopt;
  }
  return result;
}

}  // namespace

void reject_value(const SettingValue& value, std::string_view expected) {
  throw UsageError(fmt::format("is {}, expected {}", quoted_json(value), expected));
}

int to_integer(const SettingValue& value) {
  std::optional<long long> number;
  if (value.is_number_integer()) {
    number = value.get<long long>();
  } else if (value.is_string()) {
    number = parse<long long>(value.get_ref<const std::string&>());
  }
  if (!number || *number < std::numeric_limits<int>::min() ||
      *number > std::numeric_limits<int>::max()) {
    reject_value(value, "a whole number");
  }
  return static_cast<int>(*number);
}

double to_number(const SettingValue& value) {
  std::optional<double> number;
  if (value.is_number()) {
    number = value.get<double>();
  } else if (value.is_string()) {
    number = parse<double>(value.get_ref<const std::string&>());
  }
  if (!number || !std::isfinite(*number)) {
    reject_value(value, "a number");
  }
  return *number;
}

bool to_truth(const SettingValue& value) {
  if (value.is_boolean()) {
    return value.get<bool>();
  }
  if (value == "true" || value == "false") {
    return value == "true";
  }
  reject_value(value, "true or false");
}

std::string to_text(const SettingValue& value) {
  if (!value.is_string()) {
    reject_value(value, "a text");
  }
  return value.get<std::string>();
}

bool is_word(const SettingValue& value, std::string_view word) {
  return value.is_string() && value.get_ref<const std::string&>() == word;
}

std::vector<SettingValue> to_list(const SettingValue& value) {
  return value.is_array() ? std::vector<SettingValue>(value.begin(), value.end())
                          : std::vector<SettingValue>{value};
}

std::vector<std::string> split(std::string_view text, char separator) {
  std::vector<std::string> parts;
  for (;;) {
    const std::size_t end = text.find(separator);
    parts.emplace_back(text.substr(0, end));
    if (end == std::string_view::npos) {
      return parts;
    }
    text.remove_prefix(end + 1);
  }
}

void require_above_0(std::string_view name, const std::optional<double>& value) {
  if (value && !(*value > 0 && std::isfinite(*value))) {
    throw UsageError(fmt::format("--{} is {}, expected a number above 0", name, *value));
  }
}

}  // namespace vantage
