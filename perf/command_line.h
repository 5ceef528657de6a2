#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>
#include <map>
#include <optional>
#include <string>

namespace vantage::perf {

/// Parses a program's options `--name VALUE` and flags `--name`. Anything else ends the program
/// with `usage` and exit code 2. Values must not start with two dashes.
class CommandLine {
 public:
  CommandLine(int argc, char** argv, std::string usage) : usage_(std::move(usage)) {
    const auto is_name = [](const std::string& text) { return text.rfind("--", 0) == 0; };
    for (int i = 1; i < argc; ++i) {
      const std::string name = argv[i];
      if (!is_name(name)) {
        refuse();
      }
      const bool has_value = i + 1 < argc && !is_name(argv[i + 1]);
      values_[name] = has_value ? std::optional<std::string>(argv[++i]) : std::nullopt;
    }
  }

  [[nodiscard]] std::optional<std::string> text(const std::string& name) {
    const auto place = values_.find(name);
    if (place == values_.end()) {
      return std::nullopt;
    }
    if (!place->second) {
      refuse();
    }
    std::optional<std::string> value = place->second;
    values_.erase(place);
    return value;
  }
  /// Whether the flag `--name` was given; flags take no value.
  [[nodiscard]] bool flag(const std::string& name) {
    const auto place = values_.find(name);
    if (place == values_.end()) {
      return false;
    }
    if (place->second) {
      refuse();
    }
    values_.erase(place);
    return true;
  }
  /// An integer ≥ 1.
  [[nodiscard]] int number(const std::string& name, int otherwise) {
    const std::optional<std::string> value = text(name);
    if (!value) {
      return otherwise;
    }
    char* end = nullptr;
    const long number = std::strtol(value->c_str(), &end, 10);
    if (value->empty() || *end != '\0' || number < 1 || number > 1'000'000) {
      refuse();
    }
    return static_cast<int>(number);
  }
  /// WIDTHxHEIGHT; without the option both are unchanged.
  void size(const std::string& name, int& width, int& height) {
    const std::optional<std::string> value = text(name);
    if (value && std::sscanf(value->c_str(), "%dx%d", &width, &height) != 2) {
      refuse();
    }
  }
  /// Call after all options were read: refuses the remaining ones.
  void finish() const {
    if (!values_.empty()) {
      refuse();
    }
  }
  /// For values that only the program can check.
  [[noreturn]] void refuse() const {
    fmt::print(stderr, "{}\n", usage_);
    std::exit(2);
  }

 private:
  std::string usage_;
  std::map<std::string, std::optional<std::string>> values_;  ///< empty for flags
};

}  // namespace vantage::perf
