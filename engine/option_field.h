#pragma once

#include <optional>

namespace vantage {

/// Field of an options struct that a user may leave empty.
template <typename T>
using OptionalField = std::optional<T>;

}  // namespace vantage
