#pragma once

#include "engine/image/disparity_range.h"
#include "engine/matching/options/match_options.h"
#include "scheduler/range.h"

namespace vantage {

/// SearchSize::kAuto halves the images until at most so many candidates are left per pixel of the
/// whole image: each reduction leaves an eighth. About equal times for all ranges.
inline constexpr int kMaxFullSizeCandidates = 16;

/// How many times images of this size are halved for the search of these options (search_size); 0:
/// it is done at full size, as in all images of less than 32 rows or columns.
int search_reductions(const ResolvedMatchOptions& options, scheduler::Extent image);

/// `options` for images halved so many times. `whole_range`: of the images.
ResolvedMatchOptions at_reduction(const ResolvedMatchOptions& options, DisparityRange whole_range,
                                  int reductions);

/// The options of the search of all candidates in images halved so many times.
ResolvedMatchOptions reduced_options(const ResolvedMatchOptions& options,
                                     DisparityRange whole_range, int reductions);

}  // namespace vantage
