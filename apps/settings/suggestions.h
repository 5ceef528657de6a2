#pragma once

#include <string>
#include <vector>

namespace vantage::apps {

// Thread rule of all: pure.

// The hint after "unknown … 'name'": what users of other programs mean by the word, else the
// nearest known name, else where all names are listed.

/// Hint for an option (with dashes) of `command`, whose options are `known`.
std::string hint_for_option(const std::string& command, const std::string& name,
                            const std::vector<std::string>& known);
std::string hint_for_command(const std::string& name, const std::vector<std::string>& known);

}  // namespace vantage::apps
