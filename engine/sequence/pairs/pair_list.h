#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "engine/sequence/pairs/pair_source.h"

namespace vantage {

/// A line of a list of pairs; the reader resolves relative names of images.
struct ListedPair {
  std::filesystem::path left;
  std::filesystem::path right;
  PairDetails details = {};  ///< the calibration is relative to the file as given
};

/// Parses a list of pairs; see PairSourceOptions::pairs for the format. What separates the fields
/// of the first line is a comma, else a semicolon, a tab or blanks. Lines end with LF, CRLF or
/// CR; a byte order mark is skipped. Throws Error naming `file` and the line.
std::vector<ListedPair> parse_pair_list(std::string_view text, const std::filesystem::path& file);

/// parse_pair_list() of a file, without a first line that names no images where others do: a
/// heading of other names, which `remarks` tell. Throws Error, also when it cannot be read.
std::vector<ListedPair> read_pair_list(const std::filesystem::path& file,
                                       std::vector<std::string>* remarks = nullptr);

}  // namespace vantage
