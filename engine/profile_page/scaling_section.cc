#include <fmt/format.h>

#include <algorithm>

#include "engine/profile_page/page_sections.h"
#include "engine/profile_page/page_table.h"
#include "engine/profile_page/quantity_text.h"
#include "engine/profile_page/speed_up_chart.h"

namespace vantage {
namespace {

std::string scaling_table(const Profile& profile) {
  const bool has_frames = profile.thread_counts.back().frames_per_s.median > 0;
  PageTable table;
  table.columns = {
      {"threads"}, {"runs"},     {"wall time"},  {"compute"}, {has_frames ? "frames/s" : "cells/s"},
      {"works"},   {"speed-up"}, {"efficiency"}, {"serial"}};
  for (const ThreadCountProfile& count : profile.thread_counts) {
    const auto speed_up = std::ranges::find(profile.speed_ups, count.threads, &SpeedUp::threads);
    const bool has_speed_up = speed_up != profile.speed_ups.end();
    table.rows.push_back(
        {std::to_string(count.threads), std::to_string(count.runs), sample_text(count.wall_s, "s"),
         sample_text(count.compute_s, "s"),
         has_frames ? plain_sample_text(count.frames_per_s) : sample_text(count.cells_per_s, ""),
         percent_text(count.work_share.median),
         has_speed_up ? plain_sample_text(speed_up->ratio, "×") : "–",
         has_speed_up ? percent_text(speed_up->efficiency) : "–",
         has_speed_up && speed_up->serial_fraction ? percent_text(*speed_up->serial_fraction)
                                                   : "–"});
  }
  return table_markup(table);
}

}  // namespace

std::string scaling_section(const Profile& profile) {
  constexpr std::string_view kTitle = "Speed-up with threads";
  if (profile.thread_counts.empty()) {
    return section_markup(kTitle, note("No run was measured."));
  }
  const std::string table = scaling_table(profile);
  if (profile.speed_ups.size() < 2) {
    return section_markup(
        kTitle, table + note("One number of threads was measured, so there is no speed-up."));
  }
  std::string legend = "<p class=\"legend\">" + colour_key("measured", "measured, with range") +
                       colour_key("ideal-field", "ideal");
  if (profile.serial_fraction) {
    legend += colour_key("fitted-field", fmt::format("Amdahl's law with a serial fraction of {}",
                                                     percent_text(*profile.serial_fraction)));
  }
  return section_markup(
      kTitle,
      side_by_side(speed_up_chart(profile),
                   legend + "</p>\n" +
                       note("Speed-ups are ratios within a round of runs. Serial: Karp and Flatt's "
                            "fraction; below 0, more threads help more than there are of them.")) +
          table);
}

}  // namespace vantage
