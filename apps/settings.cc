#include "apps/settings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <cstdio>
#include <stdexcept>

#include "apps/option_reference.h"
#include "apps/suggestions.h"
#include "apps/toml_file.h"
#include "engine/error.h"
#include "engine/io/stored_name.h"
#include "engine/quoted_text.h"

namespace vantage::apps {
namespace {

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

std::string upper_case(std::string text) {
  for (char& letter : text) {
    letter = static_cast<char>(std::toupper(static_cast<unsigned char>(letter)));
  }
  return text;
}

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

/// `text` in lines that fit beside the names of the options, or are `columns` wide.
std::string wrapped(const std::string& text, std::size_t columns = 70) {
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

/// Whether the option and its value are too long for one line of the help.
bool is_long(const Setting& setting) {
  constexpr std::size_t kMaxColumns = 80;
  return setting.name.size() + setting.value_name.size() > kMaxColumns;
}

CLI::Option* add_option(CLI::App& app, const Setting& setting) {
  CLI::Option* option = nullptr;
  const std::string help =
      wrapped(is_long(setting) ? fmt::format("{}. NAME: {}", setting.help,
                                             fmt::join(split(setting.value_name, '|'), ", "))
                               : setting.help);
  if (setting.flag) {
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

/// Prints the help of `app`, whose `options` are those of `settings`: the settings in `names` under
/// one heading, or all in their groups when there are no names.
void print_help(CLI::App& app, const std::vector<CLI::Option*>& options,
                const std::deque<Setting>& settings, const std::vector<std::string_view>& names) {
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
  }
  std::string text = app.help();
  for (std::size_t at = text.find("\n\n\n"); at != std::string::npos;
       at = text.find("\n\n\n", at)) {
    text.erase(at, 1);  // one blank line between groups
  }
  std::fputs(text.c_str(), stdout);
}

/// Appends the options of `app` that every command has, which are not those of its settings.
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
    setting.flag = option->get_items_expected_max() == 0;
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

Setting& Settings::flag(std::string name, bool& field, std::string help) {
  Setting& setting = add(std::move(name), "", std::move(help));
  setting.flag = true;
  setting.set = [&field](const SettingValue& value) { field = to_truth(value); };
  setting.get = [&field] { return field; };
  return setting;
}

Setting& Settings::integer(std::string name, int& field, std::string value_name, std::string help) {
  Setting& setting = add(std::move(name), std::move(value_name), std::move(help));
  setting.set = [&field](const SettingValue& value) { field = to_integer(value); };
  setting.get = [&field] { return field; };
  return setting;
}

Setting& Settings::number(std::string name, double& field, std::string value_name,
                          std::string help) {
  Setting& setting = add(std::move(name), std::move(value_name), std::move(help));
  setting.set = [&field](const SettingValue& value) { field = to_number(value); };
  setting.get = [&field] { return field; };
  return setting;
}

namespace {

template <typename T, typename Parse>
void bind_optional(Setting& setting, std::optional<T>& field, const std::string& unset_name,
                   const Parse& parse) {
  setting.set = [&field, unset_name, parse](const SettingValue& value) {
    if (value.is_string() && value.get_ref<const std::string&>() == unset_name) {
      field.reset();
      return;
    }
    field = parse(value);
  };
  setting.get = [&field, unset_name]() -> SettingValue {
    return field ? SettingValue(*field) : SettingValue(unset_name);
  };
}

}  // namespace

Setting& Settings::integer(std::string name, std::optional<int>& field, std::string value_name,
                           std::string help, const std::string& unset_name) {
  Setting& setting = add(std::move(name), std::move(value_name), std::move(help));
  bind_optional(setting, field, unset_name, to_integer);
  return setting;
}

Setting& Settings::number(std::string name, std::optional<double>& field, std::string value_name,
                          std::string help, const std::string& unset_name) {
  Setting& setting = add(std::move(name), std::move(value_name), std::move(help));
  bind_optional(setting, field, unset_name, to_number);
  return setting;
}

Setting& Settings::text(std::string name, std::string& field, std::string value_name,
                        std::string help) {
  Setting& setting = add(std::move(name), std::move(value_name), std::move(help));
  setting.set = [&field](const SettingValue& value) { field = to_text(value); };
  setting.get = [&field]() -> SettingValue {
    return field.empty() ? SettingValue() : SettingValue(field);
  };
  return setting;
}

Setting& Settings::path(std::string name, std::string& field, std::string value_name,
                        std::string help) {
  Setting& setting = text(std::move(name), field, std::move(value_name), std::move(help));
  setting.path = PathRole::kOther;
  return setting;
}

Setting& Settings::input_path(std::string name, std::string& field, std::string value_name,
                              std::string help) {
  Setting& setting = path(std::move(name), field, std::move(value_name), std::move(help));
  setting.path = PathRole::kInput;
  return setting;
}

Setting& Settings::positional(std::string name, std::string& field, std::string help) {
  Setting& setting = input_path(std::move(name), field, "", std::move(help));
  setting.value_name = upper_case(setting.name);
  setting.positional = true;
  return setting;
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
  std::string config_path;
  bool print_config = false;
  bool help_json = false;
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
  app.add_option("--config", config_path, "Read settings from this TOML file; options override it")
      ->type_name("FILE.toml")
      ->group("Settings");
  app.add_flag("--print-config", print_config, "Write all settings in effect as TOML and stop")
      ->group("Settings");

  std::string job_file;
  if (takes_job_file_) {
    app.add_option("JOB", job_file, "Read settings from this TOML file, as --config does")
        ->type_name("")
        ->group("Settings");
  }
  app.set_help_flag("-h,--help", short_help_.empty() ? "Print this help and exit"
                                                     : "Print the most used options and exit")
      ->group("Settings");
  app.set_help_all_flag("--help-all", "Print all options and exit")->group("Settings");
  app.add_flag("--help-json", help_json, "Print all options as JSON and exit")->group("Settings");
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
  if (help_json) {
    SettingValue reference =
        command_reference(command_, summary_, settings_, short_help_, examples_);
    append_general_options(app, options, reference["options"]);
    std::fputs((reference.dump(2) + '\n').c_str(), stdout);
    return false;
  }

  if (!job_file.empty() && !config_path.empty()) {
    throw UsageError(
        fmt::format("settings are to be read from '{}' and from '{}', expected one file", job_file,
                    config_path));
  }
  if (const std::string& path = job_file.empty() ? config_path : job_file; !path.empty()) {
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

  if (print_config) {
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
