#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace vantage::apps {

// Thread rule of all: pure.

/// The candidate that `text` is probably meant to be: it takes the fewest edits (insertion,
/// deletion, substitution, exchange of neighbours), at most one for each four letters, or begins
/// with `text`. Empty when none is so near.
std::string nearest_name(std::string_view text, const std::vector<std::string>& candidates);

// What to say behind "unknown … 'name'": the nearest known name, else what users of other programs
// mean by the word, else where all names are listed.

/// Of an option (with dashes) of `command`, whose options `known` are.
std::string hint_for_option(const std::string& command, const std::string& name,
                            const std::vector<std::string>& known);
std::string hint_for_command(const std::string& name, const std::vector<std::string>& known);
/// Of a key of a file.
std::string hint_for_key(const std::string& key, const std::vector<std::string>& known);

}  // namespace vantage::apps
