#include <fmt/format.h>

#include <string>

#include "engine/error.h"
#include "engine/library/handles.h"
#include "engine/options/execution_settings.h"
#include "engine/options/match_settings.h"
#include "engine/options/pair_source_settings.h"
#include "engine/options/settings.h"
#include "engine/options/synthesis_settings.h"

MatcherOptions::MatcherOptions(const std::vector<std::string_view>& texts)
    : match(vantage::options_with_found_range()) {
  vantage::Settings settings;
  vantage::add_match_settings(settings, match);
  vantage::add_synthesis_settings(settings, synthesis);
  vantage::add_execution_settings(settings, execution);
  vantage::add_white_level_setting(settings, white_level);
  vantage::add_rows_setting(settings, rows);
  vantage::SettingValue values = vantage::SettingValue::object();
  for (const std::string_view text : texts) {
    const std::size_t end = text.find('=');
    if (end == std::string_view::npos) {
      throw vantage::UsageError(fmt::format("option is '{}', expected NAME=VALUE", text));
    }
    values[std::string(text.substr(0, end))] = std::string(text.substr(end + 1));
  }
  settings.take_values(values);
  match.validate();
  synthesis.validate();
  execution.validate();
}
