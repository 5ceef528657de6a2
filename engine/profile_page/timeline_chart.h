#pragma once

#include <string>

#include "engine/profile_page/part_colours.h"
#include "engine/profiling/profile.h"

namespace vantage {

/// SVG: what every thread did when, a row per thread, those outside of the pool below the others.
/// Work has the colour of its part, every other frame is fainter; spans that have room name their
/// frame. The timeline must not be empty.
std::string timeline_chart(const Profile& profile, const PartColours& colours);

}  // namespace vantage
