#pragma once

#include <cstdlib>
#include <map>
#include <sstream>

#include "tests/apps/run_fixture.h"
#include "tests/test_paths.h"

namespace vantage {

/// Environment in which `library` is loaded before all others, with `variables`.
inline Words preloaded(const std::string& library, const Words& variables) {
  const char* options = std::getenv("ASAN_OPTIONS");
  // The sanitizer wants to be the first library, but these do without its functions.
  return joined(
      {"LD_PRELOAD=" + library, std::string("ASAN_OPTIONS=") + (options == nullptr ? "" : options) +
                                    ":verify_asan_link_order=0"},
      variables);
}

/// Environment in which files below `folder` have a fault of tests/preload/io_faults.cc: "KILL"
/// ends the process before a call, "FAIL" lets one fail, "SPACE" is a full disk, "SHORT" moves few
/// bytes.
inline Words fault_at(const std::string& fault, const std::string& value,
                      const std::string& folder) {
  return preloaded(test_paths::io_faults(),
                   {"IO_FAULTS_FOLDER=" + folder, "IO_FAULTS_" + fault + "=" + value});
}
inline Words fault_at(const std::string& fault, int call, const std::string& folder) {
  return fault_at(fault, std::to_string(call), folder);
}

/// The calls on files below a folder, in order.
struct FileCalls {
  Words names;                        ///< of those that change files: "rename", "write", …
  std::map<std::string, int> counts;  ///< how many of each name there were, "read" and "close" too
  std::vector<int> writes;            ///< bytes of each write

  [[nodiscard]] int count() const { return static_cast<int>(names.size()); }
  /// Numbers (from 1) of those of this name.
  [[nodiscard]] std::vector<int> numbers_of(const std::string& name) const {
    std::vector<int> numbers;
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (names[i] == name) {
        numbers.push_back(static_cast<int>(i) + 1);
      }
    }
    return numbers;
  }
  /// Numbers of the first and the last of each of these names.
  [[nodiscard]] std::vector<int> ends_of(const Words& wanted) const {
    std::vector<int> ends;
    for (const std::string& name : wanted) {
      if (const std::vector<int> numbers = numbers_of(name); !numbers.empty()) {
        ends.insert(ends.end(), {numbers.front(), numbers.back()});
      }
    }
    return ends;
  }
};

/// Runs the program to its end and notes its calls on files below `folder`.
inline FileCalls calls_of(const Words& arguments, const std::string& folder) {
  const TemporaryFolder notes;
  succeeds(run_vantage(
      arguments, joined(fault_at("KILL", -1, folder), {"IO_FAULTS_COUNT=" + (notes / "count")})));
  std::istringstream lines(read_file(notes / "count"));
  std::size_t count = 0;
  std::size_t noted = 0;
  std::string name;
  int bytes = 0;
  FileCalls calls;
  for (lines >> count; lines >> name >> bytes; ++noted) {
    ++calls.counts[name];
    if (name != "read" && name != "close") {
      calls.names.push_back(name);
    }
    if (bytes > 0) {
      calls.writes.push_back(bytes);
    }
  }
  EXPECT_EQ(noted, count) << "more calls than are noted";
  return calls;
}

}  // namespace vantage
