#pragma once

#include <cstdlib>
#include <string>
#include <vector>

#include "tests/apps/run_fixture.h"
#include "tests/test_paths.h"

namespace vantage {

/// Environment in which `library` is loaded before all others, with `variables`.
inline std::vector<std::string> preloaded(const std::string& library,
                                          const std::vector<std::string>& variables) {
  const char* options = std::getenv("ASAN_OPTIONS");
  // The sanitizer wants to be the first library, but these do without its functions.
  return joined(
      {"LD_PRELOAD=" + library, std::string("ASAN_OPTIONS=") + (options == nullptr ? "" : options) +
                                    ":verify_asan_link_order=0"},
      variables);
}

/// Environment in which something happens at call number `call` of those that change files below
/// `folder`: "KILL" ends the process before it, "FULL" is a full disk from then on.
inline std::vector<std::string> fault_at(const std::string& fault, int call,
                                         const std::string& folder) {
  return preloaded(test_paths::io_faults(), {"IO_FAULTS_FOLDER=" + folder,
                                             "IO_FAULTS_" + fault + "=" + std::to_string(call)});
}

}  // namespace vantage
