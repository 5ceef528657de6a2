#include "apps/settings/command_line.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <cstdio>

#include "apps/settings/option_reference.h"
#include "apps/settings/setting_help.h"
#include "apps/settings/suggestions.h"
#include "apps/settings/toml_file.h"
#include "engine/error.h"
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

/// Sets what the file says; what differs from the present values counts as set by the user.
void read_settings_file(const std::string& path, Settings& settings) {
  const SettingValue values = read_toml(path);
  settings.set_file(path);
  for (const auto& [key, value] : values.items()) {
    const Setting* const setting = settings.find(key);
    if (setting == nullptr) {
      std::vector<std::string> names;
      for (const Setting& known : settings.all()) {
        names.push_back(known.name);
      }
      throw UsageError(fmt::format("{}: unknown key '{}'{}", path, quotable(key),
                                   hint_for_option(settings.command(), key, names)));
    }
    const SettingValue before = setting->get();
    setting->assign_stored(value, fmt::format("{}: {}", path, key));
    if (setting->get() != before) {
      settings.mark_set(key);
    }
  }
}

void take_texts(const Setting& setting, const std::vector<std::string>& texts,
                const std::vector<std::string>& known, Settings& settings) {
  if (setting.positional) {
    require_files(settings.command(), texts, known);
  }
  const std::string shown_name = setting.positional ? setting.value_name : "--" + setting.name;
  if (!setting.list && texts.size() > 1) {
    throw UsageError(fmt::format("{} is given {} times, expected once", shown_name, texts.size()));
  }
  setting.assign(setting.list ? SettingValue(texts) : SettingValue(texts.front()), shown_name);
  settings.mark_set(setting.name);
}

void require_complete(const Settings& settings) {
  for (const Setting& setting : settings.all()) {
    if (setting.required && setting.is_empty()) {
      throw UsageError(setting.positional
                           ? fmt::format("{} is missing; see 'vantage {} --help'",
                                         setting.value_name, settings.command())
                           : fmt::format("--{} is missing, expected --{} {}", setting.name,
                                         setting.name, setting.value_name));
    }
  }
}

}  // namespace

bool read_command_line(Settings& settings, const std::vector<std::string>& arguments) {
  const std::string& command = settings.command();
  CLI::App app(wrapped(settings.summary(), 100), "vantage " + command);
  app.allow_extras();
  std::vector<std::string> known = {"--help", "--help-all", "--help-json", "--config",
                                    "--print-config"};
  std::vector<CLI::Option*> options;
  for (const Setting& setting : settings.all()) {
    options.push_back(add_option(app, setting));
    if (!setting.positional) {
      known.push_back("--" + setting.name);
    }
    if (setting.short_name != 0) {
      known.push_back(fmt::format("-{}", setting.short_name));
    }
  }
  GeneralOptions general;
  general.add_to(app, settings.takes_job_file(), !settings.short_help().empty());
  app.footer(examples_text(settings.examples()));
  std::vector<std::string> reversed = arguments;  // as CLI11 wants them
  std::reverse(reversed.begin(), reversed.end());
  try {
    app.parse(std::move(reversed));
  } catch (const CLI::CallForHelp&) {
    print_help(app, options, settings, settings.short_help());
    return false;
  } catch (const CLI::CallForAllHelp&) {
    print_help(app, options, settings, {});
    return false;
  } catch (const CLI::ParseError& error) {
    // An unknown option is the likely cause of CLI11's error.
    require_known(command, app.remaining(), known);
    throw UsageError(first_line(error.what()));
  }
  require_known(command, app.remaining(), known);
  if (general.help_json) {
    SettingValue reference = command_reference(settings);
    append_general_options(app, options, reference["options"]);
    std::fputs((reference.dump(2) + '\n').c_str(), stdout);
    return false;
  }

  if (const std::string& path = general.file(); !path.empty()) {
    read_settings_file(path, settings);
  }
  for (std::size_t i = 0; i < options.size(); ++i) {
    if (const std::vector<std::string>& texts = options[i]->results(); !texts.empty()) {
      take_texts(settings.all()[i], texts, known, settings);
    }
  }
  if (general.print_config) {
    std::fputs(to_toml(settings).c_str(), stdout);
    return false;
  }
  require_complete(settings);
  return true;
}

std::string to_toml(const Settings& settings) {
  std::string text =
      fmt::format("# Settings of 'vantage {}'; use with --config.\n", settings.command());
  const SettingValue resolved = settings.resolved();
  const std::string* group = nullptr;
  for (const Setting& setting : settings.all()) {
    if (group == nullptr || *group != setting.group) {
      text += fmt::format("\n# {}\n", setting.group);
      group = &setting.group;
    }
    const SettingValue value = setting.stored();
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
