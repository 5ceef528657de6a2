#pragma once

#include <string>

#include "engine/error.h"
#include "engine/matching/options/match_options.h"

namespace vantage::test {

/// What validate() says against the options; empty: nothing.
inline std::string complaint(const MatchOptions& options) {
  try {
    options.validate();
  } catch (const UsageError& error) {
    return error.what();
  }
  return "";
}

}  // namespace vantage::test
