#pragma once

#include <string_view>

namespace vantage::apps {

/// The text of a file of apps/pages/comfort_page, apps/pages/figure_page, apps/pages/profile_page
/// or apps/pages/view_page
/// ("view_page/page.html") at the time the program was built. Throws std::logic_error when there is
/// none of that name.
std::string_view embedded_file(std::string_view name);

}  // namespace vantage::apps
