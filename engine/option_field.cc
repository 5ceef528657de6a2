#include "engine/option_field.h"

#include <fmt/format.h>

#include "engine/error.h"

namespace vantage {

void require_within(const Limits& limits, std::string_view option, double value) {
  if (!limits.contain(value)) {
    throw UsageError(fmt::format("{} is {}, expected {}", option, value, limits.expected));
  }
}

}  // namespace vantage
