#include "engine/matching/search/reduced/reduction.h"

#include <algorithm>
#include <cmath>

namespace vantage {
namespace {

constexpr int kMinReducedPx = 16;

int wanted_reductions(const ResolvedMatchOptions& options) {
  switch (options.parameters.search_size) {
    case SearchSize::kFull:
      return 0;
    case SearchSize::kHalf:
      return 1;
    case SearchSize::kQuarter:
      return 2;
    case SearchSize::kAuto:
      break;
  }
  int reductions = 0;
  for (int candidates = options.disparities.count();
       candidates > kMaxFullSizeCandidates && reductions < 2; candidates = (candidates + 7) / 8) {
    ++reductions;
  }
  return reductions;
}

}  // namespace

int search_reductions(const ResolvedMatchOptions& options, scheduler::Extent image) {
  int reductions = wanted_reductions(options);
  while (reductions > 0 && std::min(image.columns, image.rows) >> reductions < kMinReducedPx) {
    --reductions;
  }
  return reductions;
}

ResolvedMatchOptions at_reduction(const ResolvedMatchOptions& options, DisparityRange whole_range,
                                  int reductions) {
  ResolvedMatchOptions result = options;
  const double unit = 1 << reductions;
  result.disparities = {static_cast<int>(std::floor(whole_range.min / unit)),
                        static_cast<int>(std::ceil(whole_range.max / unit))};
  return result;
}

ResolvedMatchOptions reduced_options(const ResolvedMatchOptions& options,
                                     DisparityRange whole_range, int reductions) {
  ResolvedMatchOptions result = at_reduction(options, whole_range, reductions);
  result.parameters.search_size = SearchSize::kFull;
  result.parameters.window_levels = 0;  // ReducedSearch has its own
  result.parameters.slant_penalty *= 1 << reductions;
  return result;
}

}  // namespace vantage
