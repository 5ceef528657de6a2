#pragma once

#include <deque>
#include <functional>
#include <initializer_list>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/combinations/option_values.h"
#include "engine/options/setting_value.h"

namespace vantage {

/// How the command uses a setting that is a path.
enum class PathRole {
  kNone,   ///< not a path
  kInput,  ///< the command reads it
  kOther   ///< the command writes it or passes it to another program
};

/// What the values of a setting are, beside its words.
enum class ValueKind {
  kText,
  kWord,   ///< its words only
  kTruth,  ///< a flag
  kInteger,
  kNumber,
  kNumbers,        ///< one or more, with commas between them in a text
  kIntegerOrText,  ///< 10 or 10+5
  kNumberOrText,   ///< 0.5 or 0.5,-0.2
  kRange,          ///< two whole numbers MIN:MAX
  kPoint,          ///< two numbers X,Y
  kRectangle,      ///< four whole numbers X,Y,W,H
  kPoses           ///< the name of a file, or an array of objects
};

/// One setting: an option of the command line, a keyword argument, a key of a settings file and an
/// entry of the report, bound to a field of an option struct.
struct Setting {
  std::string name;        ///< long option and TOML key, without dashes
  std::string value_name;  ///< what --help calls the value; empty for a flag
  std::string help;
  std::string group;
  char short_name = 0;
  bool positional = false;
  bool required = false;
  ValueKind kind = ValueKind::kText;
  std::vector<std::string> words;  ///< texts that are values whatever the kind, such as auto
  bool list = false;               ///< may be given several times; an array in TOML
  bool changes_results = true;     ///< false: it affects how work is done, not the results
  PathRole path = PathRole::kNone;
  /// Sets a value, or a text (list: texts) that is read as one. Throws UsageError "is …, expected
  /// …" without the name.
  std::function<void(const SettingValue&)> set;
  /// The current value; null if there is none.
  std::function<SettingValue()> get;

  /// set() whose errors begin with `shown_name`.
  void assign(const SettingValue& value, const std::string& shown_name) const;
  /// The same for a value of a file, where paths are written by stored_name().
  void assign_stored(const SettingValue& value, const std::string& shown_name) const;
  /// The current value as it is written to a file.
  [[nodiscard]] SettingValue stored() const;
  /// Whether the current value says nothing: null, or an empty list.
  [[nodiscard]] bool is_empty() const;
};

/// All settings of a command or a call. Option structs hold their defaults until values are taken.
/// Fields are bound by reference and must outlive this object.
class Settings {
 public:
  Settings() = default;
  /// Of a command of the program, with the text above its help.
  Settings(std::string command, std::string summary)
      : command_(std::move(command)), summary_(std::move(summary)) {}

  /// Settings added after this call appear under `title` in --help-all and --print-config.
  /// `changes_results` applies to all of them.
  void start_group(std::string title, bool changes_results = true) {
    group_ = std::move(title);
    group_changes_results_ = changes_results;
  }
  /// Accept a first argument that is not an option as --config.
  void take_job_file() { takes_job_file_ = true; }
  /// What --help prints on one screen: these settings (all without names), then the examples.
  /// --help-all prints all settings. Call it after all settings are added; another call replaces
  /// the list. Throws std::logic_error for a name that no setting has.
  void set_short_help(std::vector<std::string_view> names, std::vector<std::string_view> examples);

  Setting& flag(std::string name, bool& field, std::string help);
  Setting& integer(std::string name, int& field, std::string value_name, std::string help);
  Setting& number(std::string name, double& field, std::string value_name, std::string help);
  /// The field is empty for the text `unset_name`.
  Setting& integer(std::string name, std::optional<int>& field, std::string value_name,
                   std::string help, const std::string& unset_name = "auto");
  Setting& number(std::string name, std::optional<double>& field, std::string value_name,
                  std::string help, const std::string& unset_name = "auto");
  /// Path to a file or folder that the command reads; FileChecks includes it. An empty path counts
  /// as not set, here and below.
  Setting& input_path(std::string name, std::string& field, std::string value_name,
                      std::string help);
  /// Path to a file or folder that is not read.
  Setting& path(std::string name, std::string& field, std::string value_name, std::string help);
  /// Any other text.
  Setting& text(std::string name, std::string& field, std::string value_name, std::string help);
  /// Path to read, without an option before it.
  Setting& positional(std::string name, std::string& field, std::string help);
  /// One of the names of an enumeration.
  template <typename Enum>
  Setting& choice(std::string name, Enum& field,
                  std::vector<std::pair<std::string_view, Enum>> names, std::string help);
  /// As above; the field is empty for the text `unset_name`.
  template <typename Enum>
  Setting& choice(std::string name, std::optional<Enum>& field,
                  std::vector<std::pair<std::string_view, Enum>> names, std::string help,
                  const std::string& unset_name = "auto");
  /// Any other setting: the caller fills in the rest.
  Setting& add(std::string name, std::string value_name, std::string help);

  /// Tells --print-config what `auto` means at present: `values` returns an object of setting name
  /// → value, which need not hold all names.
  void show_resolved(std::function<SettingValue()> values) { resolved_ = std::move(values); }

  /// Whether the user set it: on the command line, by a keyword, or in a file to another value than
  /// the default (a file from --print-config holds all settings).
  [[nodiscard]] bool is_set(const std::string& name) const { return set_.contains(name); }
  void mark_set(const std::string& name) { set_.insert(name); }
  /// The values by option, for rules that concern several; flags that are off, and what is empty,
  /// `auto`, `none` or `all`, are not given.
  [[nodiscard]] OptionValues option_values() const;
  /// Throws UsageError "--NAME has no effect …" for the first of `names` that is set; `why` such as
  /// "without --video".
  void refuse_idle(std::initializer_list<const char*> names, std::string_view why) const;
  /// Name → present value, in order of registration.
  [[nodiscard]] SettingValue values() const;
  /// The settings that change results, except those that are not set.
  [[nodiscard]] SettingValue result_values() const;
  /// Restores the values of result_values(), with paths as written by stored_name(). Throws
  /// UsageError naming an unknown key or an invalid value.
  void set_values(const SettingValue& values);
  /// The same for values that the user sets.
  void take_values(const SettingValue& values);
  /// A file that settings were read from.
  void set_file(const std::string& path) { file_ = path; }
  /// The paths of all inputs as the user gave them, including the file of settings.
  [[nodiscard]] std::vector<std::string> input_paths() const;

  // For those who present settings.
  [[nodiscard]] const std::string& command() const { return command_; }
  [[nodiscard]] const std::string& summary() const { return summary_; }
  [[nodiscard]] const std::deque<Setting>& all() const { return settings_; }
  /// Null: there is none of that name.
  [[nodiscard]] const Setting* find(std::string_view name) const;
  /// Throws UsageError, with the nearest name, where there is none; `given`: as the user wrote it.
  [[nodiscard]] const Setting& require(const std::string& name, const std::string& given) const;
  /// Names; empty: all.
  [[nodiscard]] const std::vector<std::string_view>& short_help() const { return short_help_; }
  [[nodiscard]] const std::vector<std::string_view>& examples() const { return examples_; }
  [[nodiscard]] bool takes_job_file() const { return takes_job_file_; }
  /// What `auto` means at present, by name.
  [[nodiscard]] SettingValue resolved() const {
    return resolved_ ? resolved_() : SettingValue::object();
  }

 private:
  template <typename Enum>
  Setting& add_choice(std::string name, std::vector<std::pair<std::string_view, Enum>> names,
                      std::string help, std::function<void(Enum)> assign,
                      std::function<std::optional<Enum>()> present);

  std::string command_;
  std::string summary_;
  std::string group_ = "Options";
  bool group_changes_results_ = true;
  bool takes_job_file_ = false;
  std::vector<std::string_view> short_help_;
  std::vector<std::string_view> examples_;
  std::function<SettingValue()> resolved_;  ///< may be empty
  std::deque<Setting> settings_;            // deque: add() hands out references
  std::set<std::string> set_;
  std::string file_;  ///< empty: none was read
};

template <typename Enum>
Setting& Settings::choice(std::string name, Enum& field,
                          std::vector<std::pair<std::string_view, Enum>> names, std::string help) {
  return add_choice<Enum>(
      std::move(name), std::move(names), std::move(help), [&field](Enum value) { field = value; },
      [&field] { return std::optional<Enum>(field); });
}

template <typename Enum>
Setting& Settings::choice(std::string name, std::optional<Enum>& field,
                          std::vector<std::pair<std::string_view, Enum>> names, std::string help,
                          const std::string& unset_name) {
  Setting& setting = add_choice<Enum>(
      std::move(name), std::move(names), std::move(help), [&field](Enum value) { field = value; },
      [&field] { return field; });
  std::erase(setting.words, unset_name);  // which may be one of the names
  setting.words.push_back(unset_name);
  const auto set_name = std::move(setting.set);
  const auto get_name = std::move(setting.get);
  setting.set = [&field, set_name, unset_name](const SettingValue& value) {
    if (value.is_string() && value.get_ref<const std::string&>() == unset_name) {
      field.reset();
    } else {
      set_name(value);
    }
  };
  setting.get = [&field, get_name, unset_name] {
    return field ? get_name() : SettingValue(unset_name);
  };
  return setting;
}

template <typename Enum>
Setting& Settings::add_choice(std::string name,
                              std::vector<std::pair<std::string_view, Enum>> names,
                              std::string help, std::function<void(Enum)> assign,
                              std::function<std::optional<Enum>()> present) {
  std::string value_name;
  std::vector<std::string> words;
  for (const auto& [text, value] : names) {
    value_name += (value_name.empty() ? "" : "|") + std::string(text);
    words.emplace_back(text);
  }
  Setting& setting = add(std::move(name), value_name, std::move(help));
  setting.kind = ValueKind::kWord;
  setting.words = std::move(words);
  setting.set = [assign, names, value_name](const SettingValue& value) {
    for (const auto& [text, choice] : names) {
      if (value.is_string() && value.get_ref<const std::string&>() == text) {
        assign(choice);
        return;
      }
    }
    reject_value(value, "one of " + value_name);
  };
  setting.get = [present, names]() -> SettingValue {
    for (const auto& [text, choice] : names) {
      if (choice == present()) {
        return std::string(text);
      }
    }
    return nullptr;
  };
  return setting;
}

}  // namespace vantage
