#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/error.h"

namespace vantage {

/// A value on its way between a struct field, the command line, a TOML file and a report. Keeps the
/// order of keys.
using SettingValue = nlohmann::ordered_json;

/// Throws UsageError "is <value>, expected <expected>".
[[noreturn]] void reject_value(const SettingValue& value, std::string_view expected);

/// The value as a whole number, a finite number, a truth value or a text; a text of the command
/// line is read as one. Throw UsageError as reject_value() does.
int to_integer(const SettingValue& value);
double to_number(const SettingValue& value);
bool to_truth(const SettingValue& value);
std::string to_text(const SettingValue& value);
/// Whether the value is this text.
bool is_word(const SettingValue& value, std::string_view word);
/// The members of an array, or the value itself.
std::vector<SettingValue> to_list(const SettingValue& value);

/// The parts of `text` between `separator`s; at least one.
std::vector<std::string> split(std::string_view text, char separator);

/// What `make` makes of the `count` parts of a text between `separator`s. `make` returns an
/// optional. Throws UsageError as reject_value() does if it is empty, `make` throws UsageError, or
/// the number of parts is another.
template <typename Make>
auto from_parts(const SettingValue& value, char separator, std::size_t count,
                std::string_view expected, const Make& make) {
  const std::vector<std::string> parts =
      split(value.is_string() ? value.get_ref<const std::string&>() : "", separator);
  try {
    if (parts.size() == count) {
      if (const auto made = make(parts)) {
        return *made;
      }
    }
  } catch (const UsageError&) {  // the message below says more
  }
  reject_value(value, expected);
}

/// Throws UsageError "--NAME is …, expected a number above 0".
void require_above_0(std::string_view name, const std::optional<double>& value);

}  // namespace vantage
