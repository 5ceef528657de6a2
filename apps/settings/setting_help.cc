#include "apps/settings/setting_help.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>

#include "apps/settings/option_reference.h"

namespace vantage::apps {
namespace {

std::string shown_default(const SettingValue& value) {
  if (value.is_string()) {
    return value.get<std::string>();
  }
  return value.is_null() || value.is_array() || value.is_boolean() ? "" : value.dump();
}

std::string option_names(const Setting& setting) {
  if (setting.positional) {
    return setting.value_name;
  }
  const std::string short_name =
      setting.short_name == 0 ? "" : fmt::format("-{},", setting.short_name);
  return short_name + "--" + setting.name;
}

/// Whether the option and its value are too long for one line of the help.
bool is_long(const Setting& setting) {
  constexpr std::size_t kMaxColumns = 80;
  return setting.name.size() + setting.value_name.size() > kMaxColumns;
}

}  // namespace

std::string wrapped(const std::string& text, std::size_t columns) {
  std::string lines;
  for (const std::string& paragraph : split(text, '\n')) {
    lines += lines.empty() ? "" : "\n";
    std::size_t column = 0;
    for (const std::string& word : split(paragraph, ' ')) {
      if (column > 0) {
        const bool fits = column + 1 + word.size() <= columns;
        lines += fits ? ' ' : '\n';
        column = fits ? column + 1 : 0;
      }
      lines += word;
      column += word.size();
    }
  }
  return lines;
}

CLI::Option* add_option(CLI::App& app, const Setting& setting) {
  CLI::Option* option = nullptr;
  const std::string help =
      wrapped(is_long(setting) ? fmt::format("{}. NAME: {}", setting.help,
                                             fmt::join(split(setting.value_name, '|'), ", "))
                               : setting.help);
  if (setting.kind == ValueKind::kTruth) {
    option = app.add_flag(option_names(setting), help);
  } else {
    // CLI11 only collects the texts; they are applied after the configuration file.
    option = app.add_option(
        option_names(setting), [](const CLI::results_t&) { return true; }, help);
    option->type_name(setting.positional ? "" : is_long(setting) ? "NAME" : setting.value_name);
    option->default_str(shown_default(setting.get()));
    if (setting.positional && setting.list) {
      option->expected(-1);  // all that follow
    }
  }
  option->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)->group(setting.group);
  return option;
}

void print_help(CLI::App& app, const std::vector<CLI::Option*>& options, const Settings& of_command,
                const std::vector<std::string_view>& names) {
  const std::deque<Setting>& settings = of_command.all();
  if (!names.empty()) {
    for (CLI::Option* const option : app.get_options()) {
      option->group("Options");
    }
  }
  if (!names.empty()) {
    app.get_option("--help-json")->group("");
  }
  for (std::size_t i = 0; i < options.size(); ++i) {
    options[i]->required(settings[i].required);  // only now: settings are also read from a file
    if (!names.empty() && std::ranges::find(names, settings[i].name) == names.end()) {
      options[i]->group("");  // hidden
    }
    if (names.empty()) {
      const std::vector<std::string> others = not_with(settings[i], of_command);
      const std::string text = fmt::format("Not with {}", fmt::join(others, ", "));
      options[i]->description(options[i]->get_description() +
                              (others.empty() ? "" : '\n' + wrapped(text)));
    }
  }
  std::string text = app.help();
  for (std::size_t at = text.find("\n\n\n"); at != std::string::npos;
       at = text.find("\n\n\n", at)) {
    text.erase(at, 1);  // one blank line between groups
  }
  std::fputs(text.c_str(), stdout);
}

void append_general_options(const CLI::App& app, const std::vector<CLI::Option*>& of_settings,
                            SettingValue& reference) {
  for (const CLI::Option* const option : app.get_options()) {
    if (std::ranges::find(of_settings, option) != of_settings.end()) {
      continue;
    }
    Setting setting;
    setting.positional = option->get_positional();
    setting.name = setting.positional ? option->get_name() : option->get_lnames().front();
    setting.short_name = option->get_snames().empty() ? '\0' : option->get_snames().front().front();
    setting.value_name = option->get_type_name();
    setting.help = option->get_description();
    setting.group = option->get_group();
    if (option->get_items_expected_max() == 0) {
      setting.kind = ValueKind::kTruth;
    }
    setting.get = [] { return SettingValue(); };
    reference.push_back(option_reference(setting, true));
  }
}

std::string examples_text(const std::vector<std::string_view>& examples) {
  std::string text = examples.empty() ? "" : "Examples:";
  for (const std::string_view example : examples) {
    text += fmt::format("\n  {}", example);
  }
  return text;
}

}  // namespace vantage::apps
