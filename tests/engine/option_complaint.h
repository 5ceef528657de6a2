#pragma once

#include "engine/matching/options/match_options.h"
#include "tests/engine/engine_test.h"

namespace vantage {
inline namespace test {

/// What validate() says against the options; empty: nothing.
inline std::string complaint(const MatchOptions& options) {
  return error_of([&] { options.validate(); });
}

}  // namespace test
}  // namespace vantage
