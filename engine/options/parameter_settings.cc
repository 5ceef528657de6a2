#include "engine/options/parameter_settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <type_traits>

#include "engine/matching/aggregation/aggregation_table.h"
#include "engine/matching/costs/cost_table.h"
#include "engine/matching/options/match_presets.h"
#include "engine/matching/options/method_fields.h"
#include "engine/matching/options/method_names.h"
#include "engine/options/option_texts.h"
#include "engine/refinement/refinement_options.h"

namespace vantage {
namespace {

constexpr const OptionText* text_of(std::string_view option) {
  return std::ranges::find(kOptionTexts, option, &OptionText::option);  // or end
}

template <typename Options>
consteval bool has_all_texts() {
  bool has_all = true;
  const Options options;
  visit_fields(
      [&has_all](const auto& field, const auto&) {
        has_all = has_all && text_of(field.option) != kOptionTexts.end();
      },
      options);
  return has_all;
}
static_assert(has_all_texts<MethodParameters>() && has_all_texts<RefinementOptions>(),
              "an option lacks its text");

constexpr MatchPreset kDefaultPreset = MatchPreset::kBalanced;

/// A line for each value of an enumeration that has a table, with its name and what it is.
template <typename Table>
std::string lines_of(const Table& table) {
  constexpr int kNameColumns = 18;
  std::string text;
  for (const auto& entry : table) {
    text += fmt::format("{:<{}} {}\n", entry.name, kNameColumns, entry.description);
  }
  return text;
}

/// The help text of a field of type T.
template <typename T>
std::string help_of(const OptionText& text, const std::string& automatic) {
  if constexpr (std::is_same_v<T, MatchCost>) {
    return fmt::format("{}:\n{}auto: {}", text.help, lines_of(cost_table()), automatic);
  } else if constexpr (std::is_same_v<T, Aggregation>) {
    return fmt::format("{}:\n{}auto: {}", text.help, lines_of(aggregation_table()), automatic);
  } else {
    return fmt::format("{}; auto: {}", text.help, automatic);
  }
}

/// "estimated" of "S|estimated"; empty if there is none.
std::string_view word_of(const OptionText& text) {
  const std::size_t bar = text.value_name.find('|');
  return bar == std::string_view::npos ? "" : text.value_name.substr(bar + 1);
}

EnumNames<bool> names_of_bool(const OptionText& text) {
  return {{text.value_name.substr(0, text.value_name.find('|')), true}, {word_of(text), false}};
}

template <typename T>
std::string default_text(const OptionText& text, T value) {
  if constexpr (std::is_same_v<T, bool>) {
    return std::string(names_of_bool(text)[value ? 0 : 1].first);
  } else if constexpr (std::is_enum_v<T>) {
    const auto names = names_of(value);
    return std::string(
        std::ranges::find(names, value, [](const auto& name) { return name.second; })->first);
  } else {
    return fmt::format("{}", static_cast<double>(value));
  }
}

template <typename T>
Setting& add_setting(Settings& settings, const OptionText& text, const std::string& automatic,
                     std::optional<T>& field) {
  const std::string name(text.option);
  const std::string help = help_of<T>(text, automatic);
  if constexpr (std::is_same_v<T, bool>) {
    return settings.choice(name, field, names_of_bool(text), help);
  } else if constexpr (std::is_enum_v<T>) {
    return settings.choice(name, field, names_of(T{}), help);
  } else {
    Setting& setting = settings.add(name, std::string(text.value_name), help);
    setting.kind = std::is_same_v<T, int> ? ValueKind::kInteger : ValueKind::kNumber;
    setting.words = {"auto"};
    if (!word_of(text).empty()) {
      setting.words.emplace_back(word_of(text));
    }
    setting.set = [&field, &text](const SettingValue& value) {
      if (is_word(value, "auto")) {
        field.reset();
      } else if (!word_of(text).empty() && is_word(value, word_of(text))) {
        field = static_cast<T>(text.word_value);
      } else if constexpr (std::is_same_v<T, int>) {
        field = to_integer(value);
      } else {
        field = to_number(value);
      }
    };
    setting.get = [&field, &text]() -> SettingValue {
      if (!field) {
        return "auto";
      }
      // Files have no infinity.
      return std::isinf(static_cast<double>(*field)) ? SettingValue(word_of(text))
                                                     : SettingValue(*field);
    };
    return setting;
  }
}

/// Lets the word of a number's setting set `flag` instead: to true, or for "none" to false. A
/// number sets it to the contrary.
void add_flag(Setting& setting, const OptionText& text, std::optional<bool>& flag) {
  const std::string_view word = word_of(text);
  const bool of_word = word != "none";
  setting.set = [&flag, word, of_word, set_number = setting.set](const SettingValue& value) {
    const bool is_automatic = is_word(value, "auto") || is_word(value, word);
    set_number(is_automatic ? SettingValue("auto") : value);
    flag = is_word(value, "auto") ? std::nullopt : std::optional(is_automatic == of_word);
  };
  setting.get = [&flag, word, of_word, number = setting.get]() -> SettingValue {
    return flag == of_word ? SettingValue(word) : number();
  };
}

/// Option → text of what `auto` stands for where neither preset nor user sets it.
using Defaults = std::map<std::string_view, std::string>;

template <typename Options>
Defaults struct_defaults() {
  Defaults texts;
  const Options defaults;
  visit_fields(
      [&texts](const auto& field, const auto& value) {
        const OptionText& text = *text_of(field.option);
        texts.try_emplace(field.option,
                          fmt::format(fmt::runtime(text.automatic), default_text(text, value)));
      },
      defaults);
  return texts;
}

/// What `auto` stands for with the preset that is in force unless another method is chosen.
template <typename Overrides>
void add_default_preset(const Overrides& preset, Defaults& texts) {
  visit_fields(
      [&texts](const auto& field, const auto& value) {
        if (value) {
          texts.at(field.option) +=
              fmt::format("; {} with preset {}", default_text(*text_of(field.option), *value),
                          name_of(kDefaultPreset));
        }
      },
      preset);
}

/// "squared; gradient for gradient, …" where the default depends on the method.
Defaults method_defaults() {
  Defaults texts = struct_defaults<MethodParameters>();
  std::map<std::string_view, const char*> separators;
  const MethodParameters defaults;
  for (const auto& method : names_of(MatchMethod{})) {
    const MethodParameters book = book_parameters(method.second);
    visit_fields(
        [&](const MethodField& field, const auto& value, const auto& default_value) {
          if (value != default_value) {
            const char* const separator = separators.try_emplace(field.option, "; ").first->second;
            texts[field.option] +=
                fmt::format("{}{} for {}", separator, default_text(*text_of(field.option), value),
                            method.first);
            separators[field.option] = ", ";
          }
        },
        book, defaults);
  }
  add_default_preset(preset_settings(kDefaultPreset).parameters, texts);
  return texts;
}

Defaults refinement_defaults() {
  Defaults texts = struct_defaults<RefinementOptions>();
  add_default_preset(preset_settings(kDefaultPreset).refinement, texts);
  return texts;
}

/// Options of the fields of `overrides` that `is_wanted`.
template <typename Overrides, typename IsWanted>
void add_settings(Settings& settings, Overrides& overrides, const Defaults& defaults,
                  const IsWanted& is_wanted) {
  Setting* setting = nullptr;
  visit_fields(
      [&](const auto& field, auto& value) {
        if (!is_wanted(field)) {
          return;
        }
        const OptionText& text = *text_of(field.option);
        if (setting != nullptr && setting->name == field.option) {
          if constexpr (std::is_same_v<decltype(value), std::optional<bool>&>) {
            add_flag(*setting, text, value);  // the second field of the option
          }
          return;
        }
        for (const auto& [first_option, group] : kOptionGroups) {
          if (first_option == field.option) {
            settings.start_group(group);
          }
        }
        setting = &add_setting(settings, text, defaults.at(field.option), value);
      },
      overrides);
}

}  // namespace

void add_method_parameters(Settings& settings, MethodOverrides& parameters) {
  add_settings(settings, parameters, method_defaults(), [](const MethodField&) { return true; });
}

void add_shared_method_parameters(Settings& settings, MethodOverrides& parameters) {
  add_settings(settings, parameters, method_defaults(),
               [](const MethodField& field) { return field.option != "iterations"; });
}

void add_refinement_options(Settings& settings, RefinementOverrides& refinement) {
  add_settings(settings, refinement, refinement_defaults(),
               [](const RefinementField&) { return true; });
}

}  // namespace vantage
