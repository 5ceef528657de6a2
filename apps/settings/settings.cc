#include "apps/settings/settings.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <cstdio>
#include <stdexcept>

#include "apps/settings/option_reference.h"
#include "apps/settings/setting_help.h"
#include "apps/settings/suggestions.h"
#include "apps/settings/toml_file.h"
#include "engine/error.h"
#include "engine/io/files/stored_name.h"
#include "engine/quoted_text.h"

namespace vantage::apps {
namespace {

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

[[noreturn]] void reject_option(const std::string& command, const std::string& argument,
                                const std::vector<std::string>& known) {
  const std::string name = argument.substr(0, argument.find('='));
  throw UsageError(
      fmt::format("unknown option '{}'{}", quotable(name), hint_for_option(command, name, known)));
}

void require_known(const std::string& command, const std::vector<std::string>& leftovers,
                   const std::vector<std::string>& known) {
  for (const std::string& argument : leftovers) {
    if (argument.size() > 1 && argument[0] == '-') {
      reject_option(command, argument, known);
    }
  }
  if (!leftovers.empty()) {
    throw UsageError(fmt::format("unexpected argument '{}'", quotable(leftovers.front())));
  }
}

void set_value(const Setting& setting, const SettingValue& value, const std::string& shown_name) {
  try {
    setting.set(value);
  } catch (const UsageError& error) {
    throw UsageError(fmt::format("{} {}", shown_name, error.what()));
  }
}

/// Options that every command has.
struct GeneralOptions {
  std::string config_path;
  std::string job_file;
  bool print_config = false;
  bool help_json = false;

  void add_to(CLI::App& app, bool takes_job_file, bool has_short_help) {
    app.add_option("--config", config_path,
                   "Read settings from this TOML file; options override it")
        ->type_name("FILE.toml")
        ->group("Settings");
    app.add_flag("--print-config", print_config, "Write all settings in effect as TOML and stop")
        ->group("Settings");
    if (takes_job_file) {
      app.add_option("JOB", job_file, "Read settings from this TOML file, as --config does")
          ->type_name("")
          ->group("Settings");
    }
    app.set_help_flag("-h,--help", has_short_help ? "Print the most used options and exit"
                                                  : "Print this help and exit")
        ->group("Settings");
    app.set_help_all_flag("--help-all", "Print all options and exit")->group("Settings");
    app.add_flag("--help-json", help_json, "Print all options as JSON and exit")->group("Settings");
  }

  /// The file to read settings from; empty: none. Throws UsageError for two.
  [[nodiscard]] const std::string& file() const {
    if (!job_file.empty() && !config_path.empty()) {
      throw UsageError(
          fmt::format("settings are to be read from '{}' and from '{}', expected one file",
                      job_file, config_path));
    }
    return job_file.empty() ? config_path : job_file;
  }
};

/// CLI11 accepts "-7" as a number, and so as a positional argument; here positional arguments are
/// files.
void require_files(const std::string& command, const std::vector<std::string>& texts,
                   const std::vector<std::string>& known) {
  for (const std::string& text : texts) {
    if (text.size() > 1 && text[0] == '-' &&
        (text[1] == '.' || std::isdigit(static_cast<unsigned char>(text[1])) != 0)) {
      reject_option(command, text, known);
    }
  }
}

/// `value` with `convert` applied to all texts.
template <typename Convert>
SettingValue with_texts(const SettingValue& value, const Convert& convert) {
  if (value.is_string()) {
    return convert(value.get_ref<const std::string&>());
  }
  SettingValue converted = value;
  if (value.is_array()) {
    for (SettingValue& member : converted) {
      member = with_texts(member, convert);
    }
  }
  return converted;
}

bool is_unset(const SettingValue& value) {
  return value.is_null() || (value.is_array() && value.empty());
}

}  // namespace

Settings::Settings(std::string command, std::string summary)
    : command_(std::move(command)), summary_(std::move(summary)) {}

Setting& Settings::add(std::string name, std::string value_name, std::string help) {
  Setting setting;
  setting.name = std::move(name);
  setting.value_name = std::move(value_name);
  setting.help = std::move(help);
  setting.group = group_;
  setting.changes_results = group_changes_results_;
  return settings_.emplace_back(std::move(setting));
}

SettingValue Settings::values() const {
  SettingValue values = SettingValue::object();
  for (const Setting& setting : settings_) {
    values[setting.name] = setting.get();
  }
  return values;
}

SettingValue Settings::result_values() const {
  SettingValue values = SettingValue::object();
  for (const Setting& setting : settings_) {
    SettingValue value = setting.get();
    if (setting.changes_results && !is_unset(value)) {
      values[setting.name] = std::move(value);
    }
  }
  return values;
}

std::vector<std::string> Settings::input_paths() const {
  std::vector<std::string> paths;
  for (const Setting& setting : settings_) {
    if (setting.path != PathRole::kInput) {
      continue;
    }
    for (const SettingValue& value : to_list(setting.get())) {
      if (value.is_string()) {
        paths.push_back(value.get<std::string>());
      }
    }
  }
  if (!config_path_.empty()) {
    paths.push_back(config_path_);
  }
  return paths;
}

void Settings::set_values(const SettingValue& values) {
  for (const auto& [key, value] : values.items()) {
    const auto setting = std::ranges::find(settings_, key, &Setting::name);
    if (setting == settings_.end()) {
      throw UsageError(fmt::format("unknown setting '{}'", quotable(key)));
    }
    set_value(*setting,
              setting->path == PathRole::kNone ? value : with_texts(value, name_of_stored), key);
  }
}

void Settings::take_values(const SettingValue& values) {
  set_values(values);
  for (const auto& [key, value] : values.items()) {
    set_.insert(key);
  }
}

void Settings::set_short_help(std::vector<std::string_view> names,
                              std::vector<std::string_view> examples) {
  for (const std::string_view name : names) {
    if (std::ranges::find(settings_, name, &Setting::name) == settings_.end()) {
      throw std::logic_error(fmt::format("no setting '{}' for the short help", name));
    }
  }
  short_help_ = std::move(names);
  examples_ = std::move(examples);
}

bool Settings::read(const std::vector<std::string>& arguments) {
  CLI::App app(wrapped(summary_, 100), "vantage " + command_);
  app.allow_extras();
  std::vector<std::string> known = {"--help", "--help-all", "--help-json", "--config",
                                    "--print-config"};
  std::vector<CLI::Option*> options;
  for (const Setting& setting : settings_) {
    options.push_back(add_option(app, setting));
    if (!setting.positional) {
      known.push_back("--" + setting.name);
    }
    if (setting.short_name != 0) {
      known.push_back(fmt::format("-{}", setting.short_name));
    }
  }
  GeneralOptions general;
  general.add_to(app, takes_job_file_, !short_help_.empty());
  app.footer(examples_text(examples_));
  std::vector<std::string> reversed = arguments;  // as CLI11 wants them
  std::reverse(reversed.begin(), reversed.end());
  try {
    app.parse(std::move(reversed));
  } catch (const CLI::CallForHelp&) {
    print_help(app, options, settings_, short_help_);
    return false;
  } catch (const CLI::CallForAllHelp&) {
    print_help(app, options, settings_, {});
    return false;
  } catch (const CLI::ParseError& error) {
    // An unknown option is the likely cause of CLI11's error.
    require_known(command_, app.remaining(), known);
    throw UsageError(first_line(error.what()));
  }
  require_known(command_, app.remaining(), known);
  if (general.help_json) {
    SettingValue reference =
        command_reference(command_, summary_, settings_, short_help_, examples_);
    append_general_options(app, options, reference["options"]);
    std::fputs((reference.dump(2) + '\n').c_str(), stdout);
    return false;
  }

  if (const std::string& path = general.file(); !path.empty()) {
    apply_config(path);
  }
  for (std::size_t i = 0; i < settings_.size(); ++i) {
    const Setting& setting = settings_[i];
    const std::vector<std::string>& texts = options[i]->results();
    if (texts.empty()) {
      continue;
    }
    if (setting.positional) {
      require_files(command_, texts, known);
    }
    const std::string shown_name = setting.positional ? setting.value_name : "--" + setting.name;
    if (!setting.list && texts.size() > 1) {
      throw UsageError(
          fmt::format("{} is given {} times, expected once", shown_name, texts.size()));
    }
    set_value(setting, setting.list ? SettingValue(texts) : SettingValue(texts.front()),
              shown_name);
    set_.insert(setting.name);
  }

  if (general.print_config) {
    std::fputs(toml().c_str(), stdout);
    return false;
  }
  require_complete();
  return true;
}

void Settings::apply_config(const std::string& path) {
  std::vector<std::string> names;
  for (const Setting& setting : settings_) {
    names.push_back(setting.name);
  }
  const SettingValue values = read_toml(path);
  config_path_ = path;
  for (const auto& [key, value] : values.items()) {
    const auto setting = std::ranges::find(settings_, key, &Setting::name);
    if (setting == settings_.end()) {
      throw UsageError(fmt::format("{}: unknown key '{}'{}", path, quotable(key),
                                   hint_for_option(command_, key, names)));
    }
    const SettingValue before = setting->get();
    set_value(*setting,
              setting->path == PathRole::kNone ? value : with_texts(value, name_of_stored),
              fmt::format("{}: {}", path, key));
    if (setting->get() != before) {
      set_.insert(setting->name);
    }
  }
}

void Settings::require_complete() const {
  for (const Setting& setting : settings_) {
    if (setting.required && is_unset(setting.get())) {
      throw UsageError(
          setting.positional
              ? fmt::format("{} is missing; see 'vantage {} --help'", setting.value_name, command_)
              : fmt::format("--{} is missing, expected --{} {}", setting.name, setting.name,
                            setting.value_name));
    }
  }
}

void Settings::refuse_idle(std::initializer_list<const char*> names, std::string_view why) const {
  for (const char* const name : names) {
    if (is_set(name)) {
      throw UsageError(fmt::format("--{} has no effect {}", name, why));
    }
  }
}

std::string Settings::toml() const {
  std::string text = fmt::format("# Settings of 'vantage {}'; use with --config.\n", command_);
  const SettingValue resolved = resolved_ ? resolved_() : SettingValue::object();
  const std::string* group = nullptr;
  for (const Setting& setting : settings_) {
    if (group == nullptr || *group != setting.group) {
      text += fmt::format("\n# {}\n", setting.group);
      group = &setting.group;
    }
    const SettingValue value =
        setting.path == PathRole::kNone ? setting.get() : with_texts(setting.get(), stored_name);
    if (value.is_null()) {
      text += fmt::format("# {} is not set\n", setting.name);
      continue;
    }
    const SettingValue meaning = resolved.value(setting.name, value);
    text += fmt::format("{} = {}{}\n", setting.name, to_toml(value),
                        meaning == value ? "" : fmt::format("  # {}", to_toml(meaning)));
  }
  return text;
}

}  // namespace vantage::apps
