#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

namespace vantage {

// Thread rule of all: pure.

/// "name" of "--name".
inline std::string_view without_dashes(std::string_view name) {
  return name.substr(std::min(name.find_first_not_of('-'), name.size()));
}

/// The candidate nearest to `text`: the one with the fewest edits (insertion, deletion,
/// substitution, exchange of neighbours), at most one per four letters, or one that starts with
/// `text`. Empty if there is none.
std::string nearest_name(std::string_view text, const std::vector<std::string>& candidates);

/// The hint after "unknown key 'name'": the nearest known one, else all.
std::string hint_for_key(const std::string& key, const std::vector<std::string>& known);

}  // namespace vantage
