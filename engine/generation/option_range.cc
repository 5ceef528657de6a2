#include "engine/generation/option_range.h"

#include <fmt/format.h>

#include "engine/error.h"

namespace vantage {

void require_between(const char* field, double value, double low, double high) {
  if (!(value >= low && value <= high)) {
    throw UsageError(fmt::format("{} is {}, expected {} to {}", field, value, low, high));
  }
}

}  // namespace vantage
