#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "engine/options/settings.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace vantage::apps {

/// `text` in lines that fit beside the names of the options, or are `columns` wide.
std::string wrapped(const std::string& text, std::size_t columns = 70);

/// The option of a setting, with its help. CLI11 only collects its texts.
CLI::Option* add_option(CLI::App& app, const Setting& setting);

/// Prints the help of `app`, whose `options` are those of `settings`: the settings in `names` under
/// one heading, or all in their groups, with what they do not go with, when there are no names.
void print_help(CLI::App& app, const std::vector<CLI::Option*>& options, const Settings& settings,
                const std::vector<std::string_view>& names);

/// Appends the options of `app` that every command has, which are not those of its settings.
void append_general_options(const CLI::App& app, const std::vector<CLI::Option*>& of_settings,
                            SettingValue& reference);

/// What stands below the options in the help.
std::string examples_text(const std::vector<std::string_view>& examples);

}  // namespace vantage::apps
