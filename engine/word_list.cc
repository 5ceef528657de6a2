#include "engine/word_list.h"

#include <fmt/format.h>

namespace vantage {

std::string word_list(const std::vector<std::string_view>& words, std::string_view conjunction) {
  if (words.size() < 2) {
    return words.empty() ? std::string() : std::string(words.front());
  }
  return fmt::format("{} {} {}", fmt::join(words.begin(), words.end() - 1, ", "), conjunction,
                     words.back());
}

}  // namespace vantage
