#pragma once

#include <string_view>

namespace vantage {

/// Whether `name` matches the shell pattern: * any characters, ? any one, [abc0-9] one of these,
/// [!abc] one of the others, everything else itself. A leading dot is matched by a dot only.
bool matches_wildcard(std::string_view pattern, std::string_view name);

}  // namespace vantage
