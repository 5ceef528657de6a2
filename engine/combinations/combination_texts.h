#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/combinations/combinations.h"

namespace vantage {

/// What `option` does not go with, as the command line writes it: "--disparities-y", "--selection
/// other than winner"; of the options that `is_known`.
std::vector<std::string> not_with(std::string_view option,
                                  const std::function<bool(std::string_view)>& is_known);

}  // namespace vantage
