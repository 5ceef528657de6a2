#include "engine/io/wildcard.h"

#include <cstddef>

namespace vantage {
namespace {

/// Length of the set at the front of `pattern`, brackets included; 0 where it is not closed (the
/// bracket then stands for itself).
std::size_t set_length(std::string_view pattern) {
  const std::size_t first = pattern.size() > 1 && pattern[1] == '!' ? 2 : 1;
  // A closing bracket right at the front is a member.
  const std::size_t end = pattern.find(']', first + 1);
  return end == std::string_view::npos ? 0 : end + 1;
}

bool set_contains(std::string_view set, char c) {
  const bool negated = set[1] == '!';
  const std::string_view members = set.substr(negated ? 2 : 1, set.size() - (negated ? 3 : 2));
  bool found = false;
  for (std::size_t i = 0; i < members.size(); ++i) {
    if (i + 2 < members.size() && members[i + 1] == '-') {
      found = found || (members[i] <= c && c <= members[i + 2]);
      i += 2;
    } else {
      found = found || members[i] == c;
    }
  }
  return found != negated;
}

/// Pattern characters that match `c` at the front of `pattern`; 0 where they do not.
std::size_t match_one(std::string_view pattern, char c) {
  if (pattern.empty()) {
    return 0;
  }
  if (pattern[0] == '?') {
    return 1;
  }
  if (pattern[0] == '[') {
    if (const std::size_t length = set_length(pattern); length > 0) {
      return set_contains(pattern.substr(0, length), c) ? length : 0;
    }
  }
  return pattern[0] == c ? 1 : 0;
}

}  // namespace

bool matches_wildcard(std::string_view pattern, std::string_view name) {
  if (name.starts_with('.') && !pattern.starts_with('.')) {
    return false;
  }
  // On a mismatch only the last star needs to take one character more.
  std::size_t after_star = std::string_view::npos;
  std::size_t star_end = 0;
  std::size_t p = 0;
  std::size_t n = 0;
  while (n < name.size()) {
    if (p < pattern.size() && pattern[p] == '*') {
      after_star = ++p;
      star_end = n;
    } else if (const std::size_t used = match_one(pattern.substr(p), name[n]); used > 0) {
      p += used;
      ++n;
    } else if (after_star != std::string_view::npos) {
      p = after_star;
      n = ++star_end;
    } else {
      return false;
    }
  }
  return pattern.find_first_not_of('*', p) == std::string_view::npos;
}

}  // namespace vantage
