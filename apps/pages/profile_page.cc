#include "apps/pages/profile_page.h"

#include "apps/pages/embedded_files.h"
#include "apps/pages/page_template.h"
#include "engine/io/files/encoded_text.h"
#include "engine/profiling/profile_json.h"

namespace vantage::apps {

std::string make_profile_page(const Profile& profile) {
  const auto file = [](std::string_view name) { return std::string(embedded_file(name)); };
  return filled_in(embedded_file("profile_page/page.html"),
                   {{"title", escaped_markup(profile.command + " – Vantage profile")},
                    {"version", escaped_markup(profile.version)},
                    {"style", file("profile_page/page.css")},
                    {"profile", json_in_html(profile_json(profile))},
                    {"content", file("profile_page/content.js")},
                    {"charts", file("profile_page/charts.js")},
                    {"script", file("profile_page/page.js")}});
}

}  // namespace vantage::apps
