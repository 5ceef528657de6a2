#include "apps/setting_value.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>

#include "engine/error.h"

namespace vantage::apps {
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

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) {
    row[j] = j;
  }
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t substituted = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, substituted});
    }
  }
  return row[b.size()];
}

}  // namespace

void reject_value(const SettingValue& value, std::string_view expected) {
  const std::string shown = value.is_string() ? "'" + value.get<std::string>() + "'" : value.dump();
  throw UsageError(fmt::format("is {}, expected {}", shown, expected));
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

std::string nearest_name(std::string_view text, const std::vector<std::string>& candidates) {
  const auto nearest = std::ranges::min_element(
      candidates, {}, [&](const std::string& name) { return edit_distance(text, name); });
  return nearest == candidates.end() ? std::string() : *nearest;
}

}  // namespace vantage::apps
