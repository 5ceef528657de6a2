#pragma once

#include <string_view>

namespace vantage::apps {

/// The text of a file of apps/view_page, as it was when the program was built. Throws
/// std::logic_error when there is none of that name.
std::string_view embedded_file(std::string_view name);

}  // namespace vantage::apps
