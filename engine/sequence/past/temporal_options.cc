#include "engine/sequence/past/temporal_options.h"

#include <fmt/format.h>

#include "engine/error.h"
#include "engine/sequence/past/still_pixels.h"

namespace vantage {

void TemporalOptions::validate() const {
  constexpr double kMaxWeight = 100;
  if (!(weight >= 0 && weight <= kMaxWeight)) {
    throw UsageError(
        fmt::format("temporal-prior is {}, expected a number from 0 to {}", weight, kMaxWeight));
  }
  StillPixels{threshold};
  if (weight > 0 && reuse != Reuse::kNone) {
    throw UsageError(
        fmt::format("temporal-prior is {} with reuse frame, expected one of them", weight));
  }
}

}  // namespace vantage
