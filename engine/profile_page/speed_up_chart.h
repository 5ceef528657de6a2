#pragma once

#include <string>

#include "engine/profiling/profile.h"

namespace vantage {

/// SVG: speed-up against threads: measured with ranges, ideal, and Amdahl's law as fitted if it is.
/// At least two numbers of threads.
std::string speed_up_chart(const Profile& profile);

}  // namespace vantage
