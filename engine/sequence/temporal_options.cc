#include "engine/sequence/temporal_options.h"

#include <fmt/format.h>

#include "engine/error.h"
#include "engine/sequence/still_pixels.h"

namespace vantage {

void TemporalOptions::validate() const {
  constexpr double kMostWeight = 100;
  if (!(weight >= 0 && weight <= kMostWeight)) {
    throw UsageError(
        fmt::format("temporal-prior is {}, expected a number from 0 to {}", weight, kMostWeight));
  }
  StillPixels{threshold};
}

}  // namespace vantage
