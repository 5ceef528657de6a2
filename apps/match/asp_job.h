#pragma once

#include <optional>
#include <string>

#include "apps/settings/common_options.h"
#include "engine/matching/options/match_options.h"
#include "engine/options/settings.h"

namespace vantage::apps {

/// Disparities of the output: Ames Stereo Pipeline counts x_right − x_left.
enum class DisparitySign { kRightMinusLeft, kLeftMinusRight };

/// What `asp` is asked for.
struct AspJob {
  std::string left;
  std::string right;
  std::string output;
  MatchPreset preset = MatchPreset::kBalanced;
  std::optional<int> min_px;  ///< in the sign of the output, as the next one; empty: found
  std::optional<int> max_px;
  DisparitySign sign = DisparitySign::kRightMinusLeft;
  CommonOptions common;
};

/// Matches the tile and writes its map, of gaps where there is nothing to match. Returns the exit
/// code. Throws UsageError and Error.
int run_asp(const AspJob& job, const Settings& settings);

}  // namespace vantage::apps
