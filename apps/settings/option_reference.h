#pragma once

#include "engine/options/setting_value.h"
#include "engine/options/settings.h"

namespace vantage::apps {

/// An option as JSON, for programs that write manual pages, completion or forms: `name`, `group`,
/// `help`, and where they apply `short_name`, `value` (placeholder), `choices` and `default`; the
/// truths `positional`, `required`, `flag`, `list` (may be given several times), `path` and
/// `common` (in the short help).
SettingValue option_reference(const Setting& setting, bool is_common);

/// A command as JSON: `command`, `summary`, `examples` and `options`.
SettingValue command_reference(const Settings& settings);

}  // namespace vantage::apps
