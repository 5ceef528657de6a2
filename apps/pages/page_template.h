#pragma once

#include <map>
#include <string>
#include <string_view>

namespace vantage::apps {

/// `page` with every {{name}} replaced by the part of that name; parts are not searched for names.
/// Throws std::out_of_range for a name without a part.
std::string filled_in(std::string_view page, const std::map<std::string_view, std::string>& parts);

/// JSON text as the content of a script element: no "</script>" may end it.
std::string json_in_html(std::string_view json);

}  // namespace vantage::apps
