#pragma once

#include <string>
#include <string_view>

namespace vantage {

/// `text` escaped for the content or a quoted attribute value of an XML or HTML element.
std::string escaped_markup(std::string_view text);

}  // namespace vantage
