#pragma once

#include "apps/settings/setting_value.h"
#include "engine/sequence/flicker.h"

namespace vantage::apps {

/// The flicker of results, for reports; null if nothing was compared.
SettingValue flicker_values(const FlickerSums& sums);

}  // namespace vantage::apps
