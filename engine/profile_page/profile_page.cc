#include "engine/profile_page/profile_page.h"

#include <fmt/format.h>

#include "engine/io/markup_text.h"
#include "engine/profile_page/page_table.h"
#include "engine/profile_page/quantity_text.h"

namespace vantage {
namespace {

std::string head_markup(const Profile& profile) {
  return fmt::format(
      "<header>\n<h1><code>{}</code></h1>\n<p>{} · {} hardware threads · {} · {} · Vantage "
      "{}</p>\n</header>\n",
      escaped_markup(profile.command), escaped_markup(profile.processor), profile.hardware_threads,
      escaped_markup(profile.isa), escaped_markup(profile.date), escaped_markup(profile.version));
}

std::string stages_markup(const Profile& profile) {
  PageTable table;
  table.columns = {{"stage", false}, {"time"}, {"ns/cell"}};
  if (!profile.thread_counts.empty()) {
    for (const StageProfile& stage : profile.thread_counts.back().stages) {
      table.rows.push_back(
          {escaped_markup(stage.name), sample_text(stage.seconds, "s"),
           stage.cells > 0 ? number_text(stage.seconds.median * 1e9 / stage.cells) : "–"});
    }
  }
  return "<section>\n<h2>Stages</h2>\n" + table_markup(table) + "</section>\n";
}

}  // namespace

std::string profile_page(const Profile& profile) {
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n"
      "<title>{} – profile</title>\n</head>\n<body>\n{}{}</body>\n</html>\n",
      escaped_markup(profile.command), head_markup(profile), stages_markup(profile));
}

}  // namespace vantage
