#pragma once

#include <map>
#include <string>
#include <string_view>

namespace vantage {

/// Values in force by the name of their option, for rules that concern several options.
class OptionValues {
 public:
  struct Value {
    double number = 0;     ///< 0 of words
    std::string word;      ///< empty of numbers
    bool is_set = false;   ///< by the user, not by a preset or a default
    bool is_given = true;  ///< false: it says that there is nothing, as `auto` and `none` do

    /// As the user writes it.
    [[nodiscard]] std::string text() const;
  };

  /// `option` must outlive this.
  void set(std::string_view option, double number, bool is_set = false) {
    values_[option] = {number, "", is_set, true};
  }
  void set(std::string_view option, std::string_view word, bool is_set = false) {
    values_[option] = {0, std::string(word), is_set, true};
  }
  void set_absent(std::string_view option, bool is_set) {
    values_[option] = {0, "", is_set, false};
  }
  /// Takes values that are known better. Whether the user set them stays.
  void take(const OptionValues& others);
  /// Null: it is not given.
  [[nodiscard]] const Value* find(std::string_view option) const {
    const auto value = values_.find(option);
    return value == values_.end() ? nullptr : &value->second;
  }

  std::string chosen;  ///< the method in words, for messages

 private:
  std::map<std::string_view, Value> values_;
};

}  // namespace vantage
