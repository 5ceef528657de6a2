#pragma once

#include "engine/options/setting_value.h"
#include "engine/rectification/vertical_error.h"

namespace vantage::apps {

/// The numbers by name, for reports.
SettingValue vertical_error_values(const VerticalError& error);

}  // namespace vantage::apps
