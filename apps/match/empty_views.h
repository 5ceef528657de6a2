#pragma once

#include <string>
#include <vector>

#include "apps/inputs/pair_input.h"
#include "engine/view_geometry/view_pose.h"

namespace vantage::apps {

/// Why a view of the pair is empty, from the positions of the left map's pixels: "82 % of it is
/// behind the camera, the rest outside the frame of 640x480 pixels".
std::string why_empty(const PairWithMaps& pair, const ViewPose& pose);

/// Warns on stderr when there are `empty_views`: how many of `poses`, which is the first, and why.
void warn_of_empty_views(const std::string& command, const PairWithMaps& pair,
                         const std::vector<ViewPose>& poses, const std::vector<int>& empty_views);

}  // namespace vantage::apps
