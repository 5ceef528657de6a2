#pragma once

#include "engine/matching/stereo_matcher.h"

namespace vantage::apps {

/// Throws Error if a left and a right map cannot be a pair with d = x_left − x_right in both: with
/// the maps or their signs exchanged, at least six tenths of the pixels would agree with their
/// partners within a pixel, and as given a quarter fewer do. The message has the shares. Accepts
/// maps of different sizes (their users refuse them) and maps that fit neither way, or both, such
/// as those of a scene at one depth.
void require_agreeing_maps(const DisparityMaps& maps);

}  // namespace vantage::apps
