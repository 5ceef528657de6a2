#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace vantage::apps {

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

}  // namespace vantage::apps
