#pragma once

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <optional>
#include <string>

namespace vantage::perf {

/// Options of a benchmark. Add all, then parse(): `--help` prints them with their defaults; wrong
/// usage ends the program with one line and exit code 2.
class CommandLine {
 public:
  explicit CommandLine(const std::string& description) : app_(description) {}

  template <typename T>
  void option(const std::string& name, T& value, const std::string& text) {
    app_.add_option(name, value, text)->capture_default_str();
  }
  template <typename T>
  void option(const std::string& name, std::optional<T>& value, const std::string& text) {
    app_.add_option_function<T>(
        name, [&value](const T& given) { value = given; }, text);
  }
  void flag(const std::string& name, bool& value, const std::string& text) {
    app_.add_flag(name, value, text);
  }
  /// An integer ≥ 1.
  void number(const std::string& name, int& value, const std::string& text) {
    app_.add_option(name, value, text)
        ->check(CLI::Range(1, 1'000'000))
        ->type_name("N")
        ->capture_default_str();
  }
  void number(const std::string& name, std::optional<int>& value, const std::string& text) {
    app_.add_option_function<int>(
            name, [&value](int given) { value = given; }, text)
        ->check(CLI::Range(1, 1'000'000))
        ->type_name("N");
  }
  /// One of the names of a table.
  template <typename T>
  void choice(const std::string& name, std::string& value, const std::map<std::string, T>& names,
              const std::string& text) {
    app_.add_option(name, value, text)->check(CLI::IsMember(&names))->capture_default_str();
  }
  void size(int& width, int& height, const std::string& text = "Size of the images") {
    app_.add_option_function<std::string>(
            "--size",
            [&width, &height](const std::string& given) {
              if (std::sscanf(given.c_str(), "%dx%d", &width, &height) != 2) {
                throw CLI::ValidationError(
                    fmt::format("--size is '{}', expected WIDTHxHEIGHT", given));
              }
            },
            text)
        ->type_name("WIDTHxHEIGHT");
  }

  // Options that many benchmarks have.
  void rounds(int& value) { number("--rounds", value, "Rounds; all contenders run in each"); }
  void threads(int& value) { number("--threads", value, "Threads"); }
  void only(std::string& value, const std::string& text) {
    app_.add_option("--only", value, text)->type_name("NAME");
  }
  void json(std::optional<std::string>& file) {
    app_.add_option_function<std::string>(
            "--json", [&file](const std::string& given) { file = given; },
            "Write the tables to this file")
        ->type_name("FILE");
  }

  void parse(int argc, char** argv) {
    try {
      app_.parse(argc, argv);
    } catch (const CLI::CallForHelp& help) {
      std::exit(app_.exit(help));
    } catch (const CLI::ParseError& error) {
      refuse(error.what());
    }
  }
  /// For values that only the program can check.
  [[noreturn]] void refuse(const std::string& reason) const {
    fmt::print(stderr, "{}; see --help\n", reason);
    std::exit(2);
  }

 private:
  CLI::App app_;
};

}  // namespace vantage::perf
