#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace vantage::apps {

// Thread rule of all: pure.

/// The candidate nearest to `text`: the one with the fewest edits (insertion, deletion,
/// substitution, exchange of neighbours), at most one per four letters, or one that starts with
/// `text`. Empty if there is none.
std::string nearest_name(std::string_view text, const std::vector<std::string>& candidates);

// The hint after "unknown … 'name'": what users of other programs mean by the word, else the
// nearest known name, else where all names are listed.

/// Hint for an option (with dashes) of `command`, whose options are `known`.
std::string hint_for_option(const std::string& command, const std::string& name,
                            const std::vector<std::string>& known);
std::string hint_for_command(const std::string& name, const std::vector<std::string>& known);
/// Hint for a key of a file.
std::string hint_for_key(const std::string& key, const std::vector<std::string>& known);

}  // namespace vantage::apps
