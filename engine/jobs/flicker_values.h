#pragma once

#include "engine/options/setting_value.h"
#include "engine/sequence/past/flicker.h"

namespace vantage {

/// The flicker of results, for reports; null if nothing was compared.
SettingValue flicker_values(const FlickerSums& sums);

}  // namespace vantage
