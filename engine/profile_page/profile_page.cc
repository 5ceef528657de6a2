#include "engine/profile_page/profile_page.h"

#include <fmt/format.h>

#include "engine/io/markup_text.h"
#include "engine/profile_page/page_sections.h"
#include "engine/profile_page/page_style.h"
#include "engine/profile_page/part_colours.h"

namespace vantage {

std::string profile_page(const Profile& profile) {
  const PartColours colours(profile);
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n"
      "<meta http-equiv=\"Content-Security-Policy\" "
      "content=\"default-src 'none'; style-src 'unsafe-inline'\"/>\n"
      "<meta name=\"viewport\" content=\"width=device-width\"/>\n"
      "<title>{} – Vantage profile</title>\n<style>{}</style>\n</head>\n<body>\n"
      "{}<main>\n{}{}{}{}</main>\n</body>\n</html>\n",
      escaped_markup(profile.command), page_style(), overview_section(profile),
      stage_section(profile), thread_section(profile, colours), scaling_section(profile),
      side_by_side(memory_section(profile), counter_section(profile)));
}

}  // namespace vantage
