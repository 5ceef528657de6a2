#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <source_location>
#include <string>
#include <utility>
#include <vector>

#include "tests/temporary_folder.h"

namespace vantage {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::AnyOf;
using testing::Contains;
using testing::ContainsRegex;
using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::IsSupersetOf;
using testing::MatchesRegex;
using testing::Not;
using testing::StartsWith;

/// Words of a command line, or names of files.
using Words = std::vector<std::string>;

/// Those of a text, where blanks divide it.
Words words(const std::string& text);
/// `some` and then `more`.
Words joined(Words some, const Words& more);

/// How a run of the binary ended.
struct ProcessResult {
  int exit_code = 0;  ///< 128 + signal when a signal ended it
  std::string out;
  std::string err;
};

/// Starts the `vantage` binary without a shell; its output goes to files in `folder`.
class VantageProcess {
 public:
  /// `environment`: variables ("NAME=value") beside, or instead of, those of this process. Without
  /// an XDG_CONFIG_HOME among them, that is a folder that is not there.
  VantageProcess(const Words& arguments, const fs::path& folder, const Words& environment = {});
  VantageProcess(const VantageProcess&) = delete;
  VantageProcess& operator=(const VantageProcess&) = delete;

  void send(int signal) const;
  /// Whether it is no longer running; wait() is to be called all the same.
  [[nodiscard]] bool has_ended() const;
  /// What it has printed on stderr so far.
  [[nodiscard]] std::string err() const;
  /// Call it once.
  [[nodiscard]] ProcessResult wait() const;

 private:
  fs::path out_;
  fs::path err_;
  int pid_ = 0;
};

/// Runs the binary to its end.
ProcessResult run_vantage(const Words& arguments, const Words& environment = {});

/// `result`, which must be that of a run that ended well; else the test fails at the caller's line.
ProcessResult succeeds(ProcessResult result,
                       std::source_location where = std::source_location::current());
/// One line on stderr that begins with "vantage COMMAND: ".
testing::AssertionResult is_one_line(const ProcessResult& result, const std::string& command);
/// A run that ended with `exit_code` and said `says`, perhaps after its plan.
void expect_failure(const ProcessResult& result, int exit_code, const std::string& says,
                    std::source_location where = std::source_location::current());
/// The same in one line.
void expect_one_line(const ProcessResult& result, int exit_code, const std::string& command,
                     const std::string& says = "",
                     std::source_location where = std::source_location::current());

/// The whole file.
std::string read_file(const fs::path& path);
/// A report, or another file of JSON.
nlohmann::json read_json(const fs::path& path);
void write_file(const fs::path& path, const std::string& content);
/// Names of all files below `folder`, relative to it, sorted. Hidden ones included.
Words files_below(const fs::path& folder);

}  // namespace vantage
