#include <fmt/format.h>

#include "engine/io/markup_text.h"
#include "engine/profile_page/page_sections.h"
#include "engine/profile_page/page_table.h"
#include "engine/profile_page/quantity_text.h"

namespace vantage {
namespace {

/// One count per another, if both are there.
void add_ratio(const HardwareCounts& hardware, const std::string& count, const std::string& per,
               const std::string& name, PageTable& table) {
  const auto above = hardware.counts.find(count);
  const auto below = hardware.counts.find(per);
  if (above != hardware.counts.end() && below != hardware.counts.end() &&
      below->second.median > 0) {
    table.rows.push_back({name, number_text(above->second.median / below->second.median)});
  }
}

}  // namespace

std::string counter_section(const Profile& profile) {
  constexpr std::string_view kTitle = "Hardware counters";
  const HardwareCounts& hardware = profile.hardware;
  std::string content;
  if (!hardware.counts.empty()) {
    PageTable table;
    table.columns = {{"counter", false}, {"per run, all threads"}};
    for (const auto& [name, sample] : hardware.counts) {
      table.rows.push_back({escaped_markup(name), sample_text(sample, "")});
    }
    add_ratio(hardware, "instructions", "cycles", "instructions per cycle", table);
    content = table_markup(table);
  }
  if (!hardware.absence.empty()) {
    content += note(hardware.absence);
  } else if (hardware.counts.empty()) {
    content = note("None were read.");
  }
  return section_markup(kTitle, content);
}

}  // namespace vantage
