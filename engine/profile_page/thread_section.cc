#include <fmt/format.h>

#include <algorithm>

#include "engine/io/markup_text.h"
#include "engine/profile_page/page_sections.h"
#include "engine/profile_page/page_table.h"
#include "engine/profile_page/quantity_text.h"
#include "engine/profile_page/timeline_chart.h"
#include "engine/profiling/profile_findings.h"

namespace vantage {
namespace {

double share_of(double part, double all) { return all > 0 ? part / all : 0; }

std::string timeline_markup(const Profile& profile, const PartColours& colours) {
  if (profile.timeline.empty()) {
    return note("There is no timeline: no trace was recorded.");
  }
  const bool has_frames =
      !profile.thread_counts.empty() && profile.thread_counts.back().frames_per_s.median > 0;
  return colours.timeline_legend(profile) + timeline_chart(profile, colours) +
         note(fmt::format("The run with the median wall time. What is too short to be seen is "
                          "joined.{}",
                          has_frames ? " Every other frame is fainter; where there is room, the "
                                       "frame's number stands in it."
                                     : ""));
}

std::string use_of_threads(const ThreadCountProfile& most) {
  if (most.workers.empty()) {
    return note("How much each thread worked is not known: no trace was recorded.");
  }
  PageTable table;
  table.columns = {{"thread", false}, {"works", false}, {"work"}, {"waits"}};
  for (const ThreadProfile& worker : most.workers) {
    const double share = share_of(worker.work_s, worker.work_s + worker.wait_s);
    table.rows.push_back(
        {escaped_markup(worker.name) + (worker.is_in_pool ? "" : " (outside of the pool)"),
         worker.is_in_pool ? bar_cell(share, percent_text(share)) : "",
         quantity_text(worker.work_s, "s"),
         worker.is_in_pool ? quantity_text(worker.wait_s, "s") : "–"});
  }
  return table_markup(table) +
         paragraph(fmt::format("The busiest thread of the pool works {} times the mean.",
                               plain_sample_text(most.imbalance)));
}

constexpr double kLeastShare = 0.001;

void add_row(const std::string& name, const std::string& time, double share, double spans,
             PageTable& table) {
  table.rows.push_back({name, time, bar_cell(share, percent_text(share)), count_text(spans)});
}

/// What takes hardly any time shares a row.
void add_rows(const std::vector<PartProfile>& parts, double all_s, bool are_waits,
              const PartColours& colours, PageTable& table) {
  int small_parts = 0;
  double small_s = 0;
  double small_spans = 0;
  for (const PartProfile& part : parts) {
    const double share = share_of(part.seconds.median, all_s);
    if (all_s > 0 && share < kLeastShare) {
      ++small_parts;
      small_s += part.seconds.median;
      small_spans += part.count;
      continue;
    }
    add_row(are_waits ? colour_key("wait", part.name + " (waiting)")
                      : colour_key(colours.class_of(part.name), part.name),
            sample_text(part.seconds, "s"), share, part.count, table);
  }
  if (small_parts > 0) {
    add_row(colour_key(are_waits ? "wait" : "part-more",
                       fmt::format("{} more, each below {}{}", small_parts,
                                   percent_text(kLeastShare), are_waits ? " (waiting)" : "")),
            quantity_text(small_s, "s"), share_of(small_s, all_s), small_spans, table);
  }
}

std::string time_by_part(const ThreadCountProfile& most, const PartColours& colours) {
  if (most.parts.empty() && most.waits.empty()) {
    return note("Where the threads' time went is not known: no trace was recorded.");
  }
  PageTable table;
  table.columns = {{"part", false}, {"time"}, {"of the pool's time", false}, {"spans"}};
  const double all_s = pool_time_s(most);
  add_rows(most.parts, all_s, false, colours, table);
  add_rows(most.waits, all_s, true, colours, table);
  const bool has_others = !std::ranges::all_of(most.workers, &ThreadProfile::is_in_pool);
  return table_markup(table) +
         (has_others
              ? note("What threads outside of the pool do is compared with its time as well.")
              : "");
}

std::string waiting_causes_markup(const ThreadCountProfile& most) {
  const WaitingProfile& causes = most.waiting_for;
  const std::pair<std::string_view, const ProfileSample*> named[] = {
      {"images being read or decoded", &causes.reading_s},
      {"tasks of other threads", &causes.computing_s},
      {"results being encoded or written", &causes.writing_s},
      {"nothing that was recorded: start, end, steps without tasks", &causes.nothing_s}};
  double waited_s = 0;
  PageTable table;
  table.columns = {{"waited for", false}, {"time"}, {"of the pool's time", false}};
  for (const auto& [name, seconds] : named) {
    const double share = share_of(seconds->median, pool_time_s(most));
    waited_s += seconds->median;
    table.rows.push_back(
        {std::string(name), sample_text(*seconds, "s"), bar_cell(share, percent_text(share))});
  }
  if (!(waited_s > 0)) {
    return note("No waiting was recorded.");
  }
  return table_markup(table) + note("Whoever waits, waits for those who work at that moment.");
}

}  // namespace

std::string thread_section(const Profile& profile, const PartColours& colours) {
  std::string timeline = section_markup("Timeline", timeline_markup(profile, colours));
  if (profile.thread_counts.empty()) {
    return timeline;
  }
  const ThreadCountProfile& most = profile.thread_counts.back();
  std::string left = section_markup("Where the threads' time goes", time_by_part(most, colours));
  std::string right = section_markup("Use of threads", use_of_threads(most));
  // What fills up the shorter column.
  (most.workers.size() < most.parts.size() + most.waits.size() ? right : left) +=
      section_markup("What waiting threads wait for", waiting_causes_markup(most));
  return timeline + side_by_side(left, right);
}

}  // namespace vantage
