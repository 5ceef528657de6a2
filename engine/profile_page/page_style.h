#pragma once

#include <string_view>

namespace vantage {

/// The style sheet of pages: light, dark and printed. Without <, > and &, so that a page stays XML.
std::string_view page_style();

}  // namespace vantage
