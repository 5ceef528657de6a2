#pragma once

#include "engine/options/setting_value.h"
#include "engine/rectification/board/board_calibration.h"

namespace vantage::apps {

/// What pictures of a board gave, on stderr: residuals of every picture, what is left out, the
/// coverage of both pictures, what to photograph next.
void print_board(const BoardCalibration& board);
/// What print_board() prints, as values of the report.
SettingValue board_values(const BoardCalibration& board);

}  // namespace vantage::apps
