#pragma once

#include <filesystem>

namespace vantage {

/// Natural order of names: numbers inside them by value (frame2 before frame10), the rest character
/// by character. A strict total order of different paths.
bool comes_before_naturally(const std::filesystem::path& left, const std::filesystem::path& right);

}  // namespace vantage
