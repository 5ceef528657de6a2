#include "engine/options/nearest_name.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace vantage {
namespace {

/// Number of insertions, deletions, substitutions and exchanges of neighbours that turn `a` into
/// `b`.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::vector<std::size_t>> edits(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) {
    for (std::size_t j = 0; j <= b.size(); ++j) {
      if (i == 0 || j == 0) {
        edits[i][j] = i + j;
        continue;
      }
      const bool is_equal = a[i - 1] == b[j - 1];
      edits[i][j] = std::min(
          {edits[i - 1][j] + 1, edits[i][j - 1] + 1, edits[i - 1][j - 1] + (is_equal ? 0 : 1)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        edits[i][j] = std::min(edits[i][j], edits[i - 2][j - 2] + 1);
      }
    }
  }
  return edits[a.size()][b.size()];
}

}  // namespace

std::string nearest_name(std::string_view text, const std::vector<std::string>& candidates) {
  constexpr std::size_t kLettersPerEdit = 4;
  constexpr std::size_t kMinPrefix = 3;
  const std::string_view letters = without_dashes(text);
  std::string nearest;
  std::size_t min_distance = (letters.size() + 1) / kLettersPerEdit + 1;
  for (const std::string& candidate : candidates) {
    const bool is_beginning = letters.size() >= kMinPrefix && candidate.starts_with(text);
    // No less than this, and all that a key of a megabyte may cost.
    const std::size_t added =
        std::max(text.size(), candidate.size()) - std::min(text.size(), candidate.size());
    if (!is_beginning && added >= min_distance) {
      continue;
    }
    const std::size_t distance = is_beginning ? 1 : edit_distance(text, candidate);
    if (distance < min_distance) {
      min_distance = distance;
      nearest = candidate;
    }
  }
  return nearest;
}

std::string hint_for_key(const std::string& key, const std::vector<std::string>& known) {
  const std::string nearest = nearest_name(key, known);
  return nearest.empty() ? fmt::format(", expected one of {}", fmt::join(known, ", "))
                         : fmt::format(", the nearest known one is '{}'", nearest);
}

}  // namespace vantage
