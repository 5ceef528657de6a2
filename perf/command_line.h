#pragma once

#include <fmt/format.h>

#include <cstdlib>
#include <map>
#include <optional>
#include <string>

namespace vantage::perf {

/// The options `--name VALUE` of a program. Anything else ends it with `usage` and exit code 2.
class CommandLine {
 public:
  CommandLine(int argc, char** argv, std::string usage) : usage_(std::move(usage)) {
    for (int i = 1; i < argc; i += 2) {
      if (i + 1 == argc || std::string(argv[i]).rfind("--", 0) != 0) {
        refuse();
      }
      values_[argv[i]] = argv[i + 1];
    }
  }

  [[nodiscard]] std::optional<std::string> text(const std::string& name) {
    const auto place = values_.find(name);
    if (place == values_.end()) {
      return std::nullopt;
    }
    std::optional<std::string> value = place->second;
    values_.erase(place);
    return value;
  }
  /// A whole number ≥ 1.
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
  /// After all options were asked for: refuses those that are left.
  void finish() const {
    if (!values_.empty()) {
      refuse();
    }
  }
  /// For values that only the program can judge.
  [[noreturn]] void refuse() const {
    fmt::print(stderr, "{}\n", usage_);
    std::exit(2);
  }

 private:
  std::string usage_;
  std::map<std::string, std::string> values_;
};

}  // namespace vantage::perf
