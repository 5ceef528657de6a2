#include "apps/batch/batch_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "apps/batch/batch_worker.h"
#include "apps/reports/text_table.h"

namespace vantage::apps {
namespace {

constexpr std::size_t kShown = 20;  ///< more lines would hide the rest; the file has all
constexpr double kHour_s = 3600;

std::string counted(std::size_t count, std::string_view thing) {
  return fmt::format("{} {}{}", count, thing, count == 1 ? "" : "s");
}

std::string description_of(const PlannedJob& job) {
  if (job.shard) {
    return fmt::format("item {}, part {}/{}", job.items.front() + 1, job.shard->index,
                       job.shard->count);
  }
  return counted(job.items.size(), job.is_list ? "pair" : "item");
}

}  // namespace

void BatchTotals::add(const ItemResult& result) {
  done += result.failed ? 0 : 1;
  with_skipped_frames += !result.failed && result.skipped > 0 ? 1 : 0;
  failed += result.failed ? 1 : 0;
  frames += result.frames;
  core_seconds += result.core_seconds;
}

std::string describe_plan(const BatchPlan& plan, const BatchJob& batch, std::size_t items) {
  std::string text = fmt::format(
      "{}, {}: {} of about {:.0f} s; {:.2f} core-hours; {:.2f} GB in, {:.2f} GB out (estimated)\n",
      counted(items, "item"), counted(static_cast<std::size_t>(plan.frames), "frame"),
      counted(plan.jobs.size(), "job"), batch.job_seconds, plan.core_seconds / kHour_s,
      plan.gigabytes_in, plan.gigabytes_out);
  TextTable table("jobs", {"job", "holds", "core-seconds", "MiB"});
  for (std::size_t i = 0; i < std::min(plan.jobs.size(), kShown); ++i) {
    const PlannedJob& job = plan.jobs[i];
    table.add({name_of_job(i), description_of(job), fmt::format("{:.1f}", job.core_seconds),
               fmt::format("{}", job.memory_bytes >> 20)});
  }
  text += table.text();
  if (plan.jobs.size() > kShown) {
    text += fmt::format("  … and {} more, see --report\n", plan.jobs.size() - kShown);
  }
  for (std::size_t i = 0; i < std::min(plan.problems.size(), kShown); ++i) {
    text += fmt::format("cannot be read now: {}\n", plan.problems[i]);
  }
  if (plan.problems.size() > kShown) {
    text += fmt::format("… and {} more\n", plan.problems.size() - kShown);
  }
  return text;
}

SettingValue plan_values(const BatchPlan& plan) {
  SettingValue jobs = SettingValue::array();
  for (std::size_t i = 0; i < plan.jobs.size(); ++i) {
    jobs.push_back({{"job", i},
                    {"items", plan.jobs[i].items},
                    {"core_seconds", plan.jobs[i].core_seconds},
                    {"memory_bytes", plan.jobs[i].memory_bytes}});
  }
  return {{"frames", plan.frames},
          {"core_seconds", plan.core_seconds},
          {"gigabytes_in", plan.gigabytes_in},
          {"gigabytes_out", plan.gigabytes_out},
          {"problems", plan.problems},
          {"jobs", std::move(jobs)}};
}

std::vector<ItemResult> item_results(const BatchPlan& plan, BatchState& state) {
  std::set<std::string> names;
  for (std::size_t i = 0; i < plan.jobs.size(); ++i) {
    const PlannedJob& job = plan.jobs[i];
    names.insert(job.shard ? name_of_merge(job.items.front()) : name_of_job(i));
  }
  std::vector<ItemResult> all;
  for (const std::string& name : names) {
    const std::vector<ItemResult> results = state.results(name);
    all.insert(all.end(), results.begin(), results.end());
  }
  std::ranges::sort(all, {}, &ItemResult::item);
  return all;
}

std::string item_lines(const std::vector<ManifestItem>& items,
                       const std::vector<ItemResult>& results) {
  std::string text;
  for (const ItemResult& result : results) {
    const ManifestItem& item = items[static_cast<std::size_t>(result.item)];
    SettingValue values = {{"line", item.line}, {"output", item.output}};
    values.update(to_values(result));
    values.erase("item");
    text += values.dump(-1, ' ', false, SettingValue::error_handler_t::replace) + "\n";
  }
  return text;
}

std::string describe_results(const std::vector<ManifestItem>& items,
                             const std::vector<ItemResult>& results) {
  BatchTotals totals;
  std::string failed;
  std::size_t shown = 0;
  for (const ItemResult& result : results) {
    totals.add(result);
    if (result.failed && ++shown <= kShown) {
      const ManifestItem& item = items[static_cast<std::size_t>(result.item)];
      failed += fmt::format("line {} ({}) failed: {}\n", item.line, item.output, result.problem);
      if (!result.command.empty()) {
        failed += fmt::format("  {}\n", result.command);
      }
    }
  }
  TextTable table("batch", {"items", "done", "frames skipped", "failed", "frames", "core-hours"});
  table.add({fmt::format("{}", items.size()), fmt::format("{}", totals.done),
             fmt::format("{}", totals.with_skipped_frames), fmt::format("{}", totals.failed),
             fmt::format("{}", totals.frames),
             fmt::format("{:.3f}", totals.core_seconds / kHour_s)});
  return table.text() + failed +
         (shown > kShown ? fmt::format("… and {} more\n", shown - kShown) : "");
}

std::string metrics_text(const BatchTotals& totals, std::size_t jobs_done, std::size_t jobs) {
  std::string text;
  const auto add = [&](std::string_view name, std::string_view type, std::string_view help,
                       std::string_view labels, double value) {
    if (!help.empty()) {
      text += fmt::format("# HELP vantage_batch_{} {}\n# TYPE vantage_batch_{} {}\n", name, help,
                          name, type);
    }
    text += fmt::format("vantage_batch_{}{} {}\n", name, labels, value);
  };
  add("jobs", "gauge", "Jobs of the batch.", "", static_cast<double>(jobs));
  add("jobs_done", "gauge", "Jobs of the batch that are done, by any worker.", "",
      static_cast<double>(jobs_done));
  add("items_total", "counter", "Items that this worker has ended.", "{status=\"done\"}",
      totals.done);
  add("items_total", "", "", "{status=\"failed\"}", totals.failed);
  add("frames_total", "counter", "Frames that this worker has delivered.", "", totals.frames);
  add("core_seconds_total", "counter", "Processor time of these frames.", "", totals.core_seconds);
  return text;
}

}  // namespace vantage::apps
