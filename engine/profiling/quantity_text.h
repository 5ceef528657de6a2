#pragma once

#include <string>
#include <string_view>

#include "engine/profiling/profile.h"

namespace vantage {

/// Human-readable quantities: three significant digits, "–" for non-finite values.

/// With an SI prefix from nano to tera before `unit`: "1.24 ms", "310 MB", "0 s".
std::string quantity_text(double value, std::string_view unit);

/// The median, followed by the range if the displayed digits differ, all in one unit: "1.24
/// (1.21–1.30) ms".
std::string sample_text(const ProfileSample& sample, std::string_view unit);

/// A fraction of 1 as percentage: "43 %", "4.3 %", "0.43 %".
std::string percent_text(double share);

/// Three significant digits without exponent up to a million: "12.4", "0.031", "1240".
std::string number_text(double value);

}  // namespace vantage
