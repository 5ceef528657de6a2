#pragma once

#include "engine/matching/stereo_matcher.h"

namespace vantage::apps {

/// Throws Error when a left and a right map cannot be a pair of maps with d = x_left − x_right in
/// both: at least six tenths of the pixels would agree with their partners within a pixel if the
/// maps, or their signs, were exchanged, and a quarter less do as they are. Names the shares. Says
/// nothing about maps that are not of one size, which whoever uses them refuses, nor about those
/// that fit neither way, or both, as those of a scene at one depth do.
void require_agreeing_maps(const DisparityMaps& maps);

}  // namespace vantage::apps
