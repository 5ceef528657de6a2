#include <fmt/format.h>

#include <algorithm>

#include "engine/io/markup_text.h"
#include "engine/profile_page/page_sections.h"
#include "engine/profile_page/page_table.h"
#include "engine/profile_page/quantity_text.h"
#include "engine/profile_page/roofline_chart.h"
#include "engine/profiling/profile_findings.h"
#include "engine/profiling/roofline.h"
#include "engine/profiling/stage_figures.h"

namespace vantage {
namespace {

constexpr std::string_view kUnknown = "–";

std::string known(double value) { return value > 0 ? number_text(value) : std::string(kUnknown); }

std::vector<std::string> row_of(const StageProfile& stage, double all_s,
                                const std::optional<ThreadRoofs>& roofs) {
  const double share = all_s > 0 ? stage.seconds.median / all_s : 0;
  const double seconds = stage.seconds.median;
  const auto rate = [&](double amount) { return seconds > 0 ? amount / seconds * 1e-9 : 0; };
  std::string roof(kUnknown);
  const auto place = roofs ? place_on_roofline(stage, *roofs) : std::nullopt;
  if (place) {
    roof = fmt::format("{} {}", percent_text(place->roof_share),
                       place->roof == Roof::kArithmetic ? "arithmetic" : "L2");
  }
  return {escaped_markup(stage.name),
          sample_text(stage.seconds, "s"),
          bar_cell(share, percent_text(share)),
          known(nanoseconds_per_cell(stage)),
          stage.cells > 0 ? quantity_text(cells_per_second(stage), "") : std::string(kUnknown),
          stage.own_columns > 0 ? percent_text(halo_share(stage)) : std::string(kUnknown),
          known(rate(stage.bytes)),
          known(rate(stage.operations)),
          roof};
}

std::string stage_table(const ThreadCountProfile& most, const std::optional<ThreadRoofs>& roofs) {
  PageTable table;
  table.columns = {{"stage", false}, {"time"},    {"share of work", false},
                   {"ns/cell"},      {"cells/s"}, {"halo"},
                   {"GB/s"},         {"GFLOP/s"}, {"of its roof"}};
  double all_s = 0;
  for (const StageProfile& stage : most.stages) {
    all_s += stage.seconds.median;
  }
  all_s = std::max(all_s, pool_work_s(most));
  for (const StageProfile& stage : most.stages) {
    table.rows.push_back(row_of(stage, all_s, roofs));
  }
  return table_markup(table) +
         note(fmt::format("On {} thread{}. Time is processor time, median and range over the runs; "
                          "rates are those of one thread while it is in the stage. Halo: columns "
                          "made beyond those that are results. Bytes are those a stage loads and "
                          "stores, whichever cache they lie in.",
                          most.threads, most.threads == 1 ? "" : "s"));
}

std::string ceiling_table(const std::vector<MachineCeilings>& all) {
  PageTable table;
  table.caption = "What the machine can do, measured";
  table.columns = {{"", false}, {"one thread"}};
  std::vector<std::string> arithmetic = {"arithmetic, GFLOP/s", known(all.front().core_gflops)};
  std::vector<std::string> l2 = {"level 2, GB/s", known(all.front().core_l2_gb_per_s)};
  std::vector<std::string> memory = {"memory, GB/s", known(all.front().core_memory_gb_per_s)};
  for (const MachineCeilings& ceilings : all) {
    if (ceilings.threads > 1) {
      table.columns.push_back({fmt::format("all of {}", ceilings.threads)});
      arithmetic.push_back(known(ceilings.all_gflops));
      l2.push_back(known(ceilings.all_l2_gb_per_s));
      memory.push_back(known(ceilings.all_memory_gb_per_s));
    }
  }
  table.rows = {arithmetic, l2, memory};
  return table_markup(table);
}

std::string about_roofline(const ThreadCountProfile& most, const ThreadRoofs& roofs) {
  std::string left_out;
  for (const StageProfile& stage : most.stages) {
    if (!place_on_roofline(stage, roofs)) {
      left_out +=
          (left_out.empty() ? " Not drawn, as they do not count their work: " : ", ") + stage.name;
    }
  }
  return note(fmt::format(
      "Roofs are the share of one thread while {} work{}. A disc is a stage: its area the time it "
      "takes, its colour the lower of the arithmetic (orange) and the level-2 (blue) roof above "
      "it. "
      "A stage above the memory line has its data in caches.{}{}",
      most.threads == 1 ? "one" : fmt::format("all {}", most.threads), most.threads == 1 ? "s" : "",
      left_out, left_out.empty() ? "" : "."));
}

std::string roofline_markup(const Profile& profile, const std::optional<ThreadRoofs>& roofs) {
  const ThreadCountProfile& most = profile.thread_counts.back();
  const std::string ceilings = profile.ceilings.empty() ? "" : ceiling_table(profile.ceilings);
  if (!roofs) {
    return note("There is no roofline: the machine's ceilings were not measured.") + ceilings;
  }
  const std::string chart = roofline_chart(most.stages, *roofs);
  if (chart.empty()) {
    return note("There is no roofline: no stage counts its operations and bytes.") + ceilings;
  }
  return side_by_side(chart, about_roofline(most, *roofs) + ceilings);
}

}  // namespace

std::string stage_section(const Profile& profile) {
  if (profile.thread_counts.empty() || profile.thread_counts.back().stages.empty()) {
    return section_markup("Stages", note("No stage of matching ran, or none was recorded."));
  }
  const auto roofs = roofs_of_most_threads(profile);
  return section_markup("Stages", stage_table(profile.thread_counts.back(), roofs)) +
         section_markup("Roofline", roofline_markup(profile, roofs));
}

}  // namespace vantage
