#pragma once

#include <deque>
#include <string>
#include <string_view>
#include <vector>

#include "apps/settings/setting_value.h"
#include "apps/settings/settings.h"

namespace vantage::apps {

/// An option as JSON, for programs that write manual pages, completion or forms: `name`, `group`,
/// `help`, and where they apply `short_name`, `value` (placeholder), `choices` and `default`; the
/// truths `positional`, `required`, `flag`, `list` (may be given several times), `path` and
/// `common` (in the short help).
SettingValue option_reference(const Setting& setting, bool is_common);

/// A command as JSON: `command`, `summary`, `examples` and `options`. `common` names the settings
/// of the short help; empty: all are.
SettingValue command_reference(const std::string& command, const std::string& summary,
                               const std::deque<Setting>& settings,
                               const std::vector<std::string_view>& common,
                               const std::vector<std::string_view>& examples);

}  // namespace vantage::apps
