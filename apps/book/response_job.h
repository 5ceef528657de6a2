#pragma once

#include <optional>
#include <string>

#include "apps/settings/common_options.h"
#include "engine/evaluation/cumulative_response.h"

namespace vantage::apps {

/// What `book response` is asked for.
struct ResponseJob {
  MethodOverrides parameters;
  std::optional<DisparityRange> displacements_x;  ///< default: −16 to a quarter of the width
  DisparityRange displacements_y = {0, 0};
  CommonOptions common;
  std::string left;
  std::string right;
  std::string output;
};

/// Sums the evidence, writes the sums and prints their maxima. Returns the exit code. Throws
/// UsageError for options that do not go together, and Error.
int run_response(const ResponseJob& job, const Settings& settings);

}  // namespace vantage::apps
