#include <fmt/format.h>

#include "engine/io/markup_text.h"
#include "engine/profile_page/page_sections.h"
#include "engine/profile_page/page_table.h"
#include "engine/profile_page/quantity_text.h"

namespace vantage {

std::string memory_section(const Profile& profile) {
  constexpr std::string_view kTitle = "Memory";
  const auto peak = static_cast<double>(profile.peak_memory_bytes);
  if (!(peak > 0)) {
    return section_markup(kTitle, note("How much memory was used is not known."));
  }
  PageTable table;
  table.columns = {{"owner", false}, {"at its peak"}, {"of the process's peak", false}};
  double owned = 0;
  const auto add = [&](const std::string& name, double bytes) {
    table.rows.push_back({escaped_markup(name), quantity_text(bytes, "B"),
                          bar_cell(bytes / peak, percent_text(bytes / peak))});
  };
  for (const MemoryOwner& owner : profile.memory) {
    add(owner.name, static_cast<double>(owner.bytes));
    owned += static_cast<double>(owner.bytes);
  }
  const std::string sum =
      paragraph(fmt::format("At most {} were resident.", quantity_text(peak, "B")));
  if (profile.memory.empty()) {
    return section_markup(kTitle, sum + note("Whose they were is not known."));
  }
  const std::string remark = owned > peak ? note(
                                                "Owners come to more than the process: their "
                                                "peaks were not at one moment.")
                                          : "";
  return section_markup(kTitle, sum + table_markup(table) + remark);
}

}  // namespace vantage
