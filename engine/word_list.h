#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace vantage {

/// "a", "a and b", "a, b and c"; `conjunction`: "and", "or". Empty for no words.
std::string word_list(const std::vector<std::string_view>& words, std::string_view conjunction);

}  // namespace vantage
