#include "engine/matching/match_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/error.h"

namespace vantage {
namespace {

constexpr int kMaxCandidates = 4096;
constexpr int kMaxDisparity = 65535;

}  // namespace

void MatchOptions::validate() const {
  const auto [least, most] = disparities;
  if (most < least) {
    throw UsageError(
        fmt::format("disparities is {}:{}, expected MIN:MAX with MIN <= MAX", least, most));
  }
  if (std::abs(static_cast<long>(least)) > kMaxDisparity ||
      std::abs(static_cast<long>(most)) > kMaxDisparity) {
    throw UsageError(fmt::format("disparities is {}:{}, expected values within ±{}", least, most,
                                 kMaxDisparity));
  }
  if (disparities.count() > kMaxCandidates) {
    throw UsageError(fmt::format("disparities is {}:{} ({} candidates), expected at most {}", least,
                                 most, disparities.count(), kMaxCandidates));
  }
  vantage::validate(resolved());
  if (refinement.speckle_size_px < 0) {
    throw UsageError(fmt::format("speckle-size is {}, expected a number of pixels, at least 0",
                                 refinement.speckle_size_px));
  }
  if (refinement.cross_check_px && !(*refinement.cross_check_px >= 1 && std::isfinite(*refinement.cross_check_px))) {
    throw UsageError(
        fmt::format("cross-check is {}, expected a number of at least 1", *refinement.cross_check_px));
  }
}

MethodParameters MatchOptions::resolved() const { return resolve(method, parameters); }

double MatchOptions::cross_check_or_default() const {
  return refinement.cross_check_px.value_or(std::max(1.0, disparities.count() / 15.0));
}

}  // namespace vantage
