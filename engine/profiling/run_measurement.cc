#include "engine/profiling/run_measurement.h"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <set>

#include "engine/profiling/profile_figures.h"

namespace vantage {
namespace {

using Runs = std::span<const RunMeasurement>;

template <typename Figure>
ProfileSample sample_over(Runs runs, const Figure& figure) {
  std::vector<double> values;
  for (const RunMeasurement& run : runs) {
    values.push_back(figure(run));
  }
  return sample_of(std::move(values));
}

template <typename Entry>
using Entries = std::map<std::string, Entry> RunMeasurement::*;

template <typename Entry>
std::set<std::string> names_in(Runs runs, Entries<Entry> entries) {
  std::set<std::string> names;
  for (const RunMeasurement& run : runs) {
    for (const auto& [name, entry] : run.*entries) {
      names.insert(name);
    }
  }
  return names;
}

/// Sample of a figure of the entry called `name`.
template <typename Entry>
ProfileSample sample_of_entry(Runs runs, Entries<Entry> entries, const std::string& name,
                              double Entry::*figure) {
  return sample_over(runs, [&](const RunMeasurement& run) {
    const auto found = (run.*entries).find(name);
    return found == (run.*entries).end() ? 0 : found->second.*figure;
  });
}

template <typename Profiled>
void sort_by_time(std::vector<Profiled>& all) {
  std::ranges::stable_sort(all, std::ranges::greater{},
                           [](const Profiled& one) { return one.seconds.median; });
}

std::vector<StageProfile> stages_of(Runs runs) {
  using Stage = RunMeasurement::Stage;
  std::vector<StageProfile> stages;
  for (const std::string& name : names_in<Stage>(runs, &RunMeasurement::stages)) {
    const auto sample = [&](double Stage::*figure) {
      return sample_of_entry<Stage>(runs, &RunMeasurement::stages, name, figure);
    };
    stages.push_back({.name = name,
                      .seconds = sample(&Stage::seconds),
                      .columns = sample(&Stage::columns).median,
                      .own_columns = sample(&Stage::own_columns).median,
                      .cells = sample(&Stage::cells).median,
                      .operations = sample(&Stage::operations).median,
                      .bytes = sample(&Stage::bytes).median});
  }
  sort_by_time(stages);
  return stages;
}

std::vector<PartProfile> parts_of(Runs runs, Entries<RunMeasurement::Part> entries) {
  using Part = RunMeasurement::Part;
  std::vector<PartProfile> parts;
  for (const std::string& name : names_in<Part>(runs, entries)) {
    const auto sample = [&](double Part::*figure) {
      return sample_of_entry<Part>(runs, entries, name, figure);
    };
    parts.push_back({.name = name,
                     .seconds = sample(&Part::seconds),
                     .count = sample(&Part::count).median,
                     .processor_s = sample(&Part::processor_s)});
  }
  sort_by_time(parts);
  return parts;
}

WaitingProfile waiting_of(Runs runs) {
  const auto sample = [&](double WaitingCauses::*cause) {
    return sample_over(runs, [&](const RunMeasurement& run) { return run.waiting_for.*cause; });
  };
  return {.reading_s = sample(&WaitingCauses::reading_s),
          .computing_s = sample(&WaitingCauses::computing_s),
          .writing_s = sample(&WaitingCauses::writing_s),
          .nothing_s = sample(&WaitingCauses::nothing_s)};
}

}  // namespace

std::map<std::string, double> median_steps(Runs runs) {
  std::map<std::string, double> medians;
  for (const std::string& name : names_in<double>(runs, &RunMeasurement::steps)) {
    medians[name] = sample_over(runs, [&](const RunMeasurement& run) {
                      const auto found = run.steps.find(name);
                      return found == run.steps.end() ? 0 : found->second;
                    }).median;
  }
  return medians;
}

std::size_t median_run(Runs runs) {
  std::vector<std::size_t> order(runs.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t run) { return runs[run].wall_s; });
  return order[(order.size() - 1) / 2];
}

double imbalance_of(std::span<const ThreadProfile> workers) {
  double max_s = 0;
  double sum_s = 0;
  int count = 0;
  for (const ThreadProfile& worker : workers) {
    if (worker.is_in_pool) {
      max_s = std::max(max_s, worker.work_s);
      sum_s += worker.work_s;
      ++count;
    }
  }
  return sum_s > 0 ? max_s * count / sum_s : 1;
}

ThreadCountProfile summarise_runs(int threads, Runs runs) {
  const auto sample = [&](double RunMeasurement::*figure) {
    return sample_over(runs, [&](const RunMeasurement& run) { return run.*figure; });
  };
  ThreadCountProfile profile;
  profile.threads = threads;
  profile.runs = static_cast<int>(runs.size());
  profile.wall_s = sample(&RunMeasurement::wall_s);
  profile.compute_s = sample(&RunMeasurement::compute_s);
  profile.cells_per_s = sample(&RunMeasurement::cells_per_s);
  profile.frames_per_s = sample(&RunMeasurement::frames_per_s);
  profile.work_share = sample(&RunMeasurement::work_share);
  profile.peak_memory_bytes = sample_over(
      runs, [](const RunMeasurement& run) { return static_cast<double>(run.peak_memory_bytes); });
  profile.imbalance =
      sample_over(runs, [](const RunMeasurement& run) { return imbalance_of(run.workers); });
  profile.frames = sample(&RunMeasurement::frames).median;
  profile.frame_steps = parts_of(runs, &RunMeasurement::frame_steps);
  profile.stages = stages_of(runs);
  profile.parts = parts_of(runs, &RunMeasurement::parts);
  profile.waits = parts_of(runs, &RunMeasurement::waits);
  profile.waiting_for = waiting_of(runs);
  profile.workers = runs[median_run(runs)].workers;
  return profile;
}

}  // namespace vantage
