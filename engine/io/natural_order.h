#pragma once

#include <filesystem>

namespace vantage {

/// Order in which people count: numbers inside the names by value (frame2 before frame10), the rest
/// character by character. A strict total order of different paths.
bool comes_before_naturally(const std::filesystem::path& left, const std::filesystem::path& right);

}  // namespace vantage
