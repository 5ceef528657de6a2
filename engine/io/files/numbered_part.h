#pragma once

#include <filesystem>
#include <optional>

namespace vantage {

/// A file that holds several pictures or tracks, and the number of one of them, counted from 0.
struct NumberedPart {
  std::filesystem::path file;
  std::optional<int> number = {};  ///< empty: none is named
};

/// FILE#NUMBER, such as "scan.tif#2" or "film.mkv#0". A file of that whole name takes precedence.
/// Thread rule: may be called concurrently.
NumberedPart numbered_part(const std::filesystem::path& spec);

}  // namespace vantage
