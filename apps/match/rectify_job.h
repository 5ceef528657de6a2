#pragma once

#include <optional>
#include <string>

#include "apps/settings/common_options.h"
#include "engine/options/settings.h"
#include "engine/rectification/board/calibration_board.h"
#include "engine/rectification/rectifier.h"
#include "engine/sequence/pairs/pair_source.h"

namespace vantage::apps {

/// What `rectify` is asked for.
struct RectifyJob {
  PairSourceOptions input;
  std::string calibration;                ///< file; empty: from the images alone
  std::optional<CalibrationBoard> board;  ///< that the pairs show; instead of a calibration
  std::optional<int> sample_pairs;        ///< empty: 10, or 50 of a board
  CalibrationChoice calibration_choice;
  RectificationOptions rectification;
  std::optional<double> baseline_m;  ///< empty: that of the calibration
  std::string output;                ///< folder
  bool overwrite = false;
  std::string matrices;
  std::string valid_mask;
  CommonOptions common;
};

/// Estimates or reads the cameras, measures the rows, and writes images, matrices and mask until
/// Ctrl-C. Returns the exit code. Throws UsageError and Error.
int run_rectify(RectifyJob& job, const Settings& settings);

}  // namespace vantage::apps
