#pragma once

#include <string>

#include "engine/options/setting_value.h"

namespace vantage::apps {

/// The keys and values of a flat TOML file. Throws Error when the file cannot be read and
/// UsageError, with file and line, when it is not TOML or a value is of a kind no setting has
/// (tables, dates).
SettingValue read_toml(const std::string& path);

/// Any TOML file, tables as objects. Throws likewise, for dates only.
SettingValue read_toml_document(const std::string& path);

/// `value` (a truth value, number, text or array of these) as TOML.
std::string to_toml(const SettingValue& value);

}  // namespace vantage::apps
