#pragma once

#include "engine/rectification/vertical_error.h"

namespace vantage {

// What it costs that rows do not correspond. Thread rule: pure.

/// The additional percentage of pixels that are wrong by more than a pixel with this row error,
/// interpolated from measurements (see the .cc file).
double more_bad_percent(double rows_off_px);
/// The percentage above which a warning is printed.
inline constexpr double kMaxMoreBad_percent = 5;

/// Whether the row error is too small to matter for matching.
bool is_rectified(const VerticalError& error);

}  // namespace vantage
