#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "engine/options/setting_value.h"
#include "engine/tuning/tuning_file.h"
#include "engine/tuning/tuning_session.h"

namespace vantage::apps {

// For people; several lines each.
std::string describe(const TuningKey& key);
std::string describe(const TuningEntry& entry);
/// A table of all that was tried, and the result.
std::string describe(const TuningReport& report, const TuningRequest& request);

/// The settings that are not left to the cost model, by the names of options.
SettingValue as_json(const TunedSettings& settings);
/// All of it, for --report. `file`: where it is kept.
SettingValue as_json(const TuningReport& report, const std::filesystem::path& file);

std::string_view name_of(TunedUse use);

}  // namespace vantage::apps
