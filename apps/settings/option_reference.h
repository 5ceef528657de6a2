#pragma once

#include <string>
#include <vector>

#include "engine/options/setting_value.h"
#include "engine/options/settings.h"

namespace vantage::apps {

/// An option as JSON, for programs that write manual pages, completion or forms: `name`, `group`,
/// `help`, and where they apply `short_name`, `value` (placeholder), `choices`
/// (the words that a value can be), `default` and, in command_reference(), `not_with`; the truths
/// `positional`, `required`, `flag`, `list` (may be given several times), `path` and `common` (in
/// the short help).
SettingValue option_reference(const Setting& setting, bool is_common);

/// The other options of a command that a setting does not go with, as users write them.
std::vector<std::string> not_with(const Setting& setting, const Settings& settings);

/// The table of combinations as JSON: `option`, `not_with` or `only_with`, `reason`, and whether
/// the value of a preset gives way (`preset_gives_way`).
SettingValue combination_reference();

/// A command as JSON: `command`, `summary`, `examples` and `options`.
SettingValue command_reference(const Settings& settings);

}  // namespace vantage::apps
