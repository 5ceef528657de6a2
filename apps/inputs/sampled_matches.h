#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "apps/reports/run_report.h"
#include "engine/execution.h"
#include "engine/rectification/feature_matches.h"
#include "engine/rectification/stereo_calibration.h"
#include "engine/sequence/pairs/pair_source.h"

namespace vantage::apps {

/// Indices of at most `max_pairs` (≥ 1) pairs, evenly spaced; with more than one, the first and the
/// last are included.
std::vector<int> sampled_pairs(int pairs, int max_pairs);

/// Reads pair `index`. Throws Error, also when its images have different sizes.
void read_equal_pair(PairSource& pairs, int index, FramePair& pair);

/// Calls work(i, pair) for pair indices[i], for as many pairs at a time as there are threads.
/// Reading and working are stages of the report ("read", "features"). Throws Error if a pair has
/// another size.
void for_each_sampled_pair(PairSource& pairs, const std::vector<int>& indices, ImageSize size,
                           Execution& execution, RunReport& report,
                           const std::function<void(std::size_t i, FramePair& pair)>& work);

/// The results of `matches_of` for these pairs, in order; see for_each_sampled_pair().
std::vector<PointMatch> gather_matches(
    PairSource& pairs, const std::vector<int>& indices, ImageSize size, Execution& execution,
    RunReport& report, const std::function<std::vector<PointMatch>(FramePair&)>& matches_of);

}  // namespace vantage::apps
