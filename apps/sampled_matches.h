#pragma once

#include <functional>
#include <vector>

#include "apps/run_report.h"
#include "engine/execution.h"
#include "engine/rectification/feature_matches.h"
#include "engine/rectification/stereo_calibration.h"
#include "engine/sequence/pair_source.h"

namespace vantage::apps {

/// Numbers of at most `most` (≥ 1) pairs, evenly spread over all; the first and the last are among
/// them where there is more than one.
std::vector<int> sampled_pairs(int pairs, int most);

/// Reads pair `index`. Throws Error, also when its images have different sizes.
void read_equal_pair(PairSource& pairs, int index, FramePair& pair);

/// What `matches_of` finds in these pairs, one after the other; it is called for as many pairs at a
/// time as there are threads. Reading and finding are stages of the report ("read", "features").
/// Throws Error when a pair is not of this size.
std::vector<PointMatch> gather_matches(
    PairSource& pairs, const std::vector<int>& indices, ImageSize size, Execution& execution,
    RunReport& report, const std::function<std::vector<PointMatch>(FramePair&)>& matches_of);

}  // namespace vantage::apps
