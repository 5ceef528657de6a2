#include "apps/batch/batch_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <future>
#include <map>
#include <utility>

#include "engine/error.h"
#include "engine/io/files/checksum.h"
#include "engine/io/files/json_text.h"
#include "scheduler/machine.h"

namespace vantage::apps {
namespace {

/// Turns items into jobs, in the order of the manifest.
class JobMaker {
 public:
  explicit JobMaker(double core_seconds) : limit_(core_seconds) {}

  void add(int index, const ItemCost& cost) {
    if (cost.is_pair) {
      add_pair(index, cost);
      return;
    }
    const int chunks = (cost.frames + cost.chunk_frames - 1) / cost.chunk_frames;
    const int shards =
        std::clamp(static_cast<int>(std::ceil(cost.core_seconds / limit_)), 1, std::max(1, chunks));
    if (shards == 1) {
      put(films_, index, cost);
      return;
    }
    for (int part = 1; part <= shards; ++part) {
      jobs_.push_back({.items = {index},
                       .shard = Shard{part, shards},
                       .core_seconds = cost.core_seconds / shards,
                       .memory_bytes = cost.memory_bytes});
    }
  }

  std::vector<PlannedJob> finish() {
    close(films_);
    for (auto& [options, job] : pairs_) {
      close(job);
    }
    return std::move(jobs_);
  }

 private:
  void add_pair(int index, const ItemCost& cost) {
    if (cost.goes_with_others) {
      put(pairs_.try_emplace(cost.options_hash, PlannedJob{.is_list = true}).first->second, index,
          cost);
      return;
    }
    jobs_.push_back({.items = {index},
                     .is_list = true,
                     .core_seconds = cost.core_seconds,
                     .memory_bytes = cost.memory_bytes});
  }

  void put(PlannedJob& job, int index, const ItemCost& cost) {
    if (!job.items.empty() && job.core_seconds + cost.core_seconds > limit_) {
      close(job);
    }
    job.items.push_back(index);
    job.core_seconds += cost.core_seconds;
    job.memory_bytes = std::max(job.memory_bytes, cost.memory_bytes);
  }

  void close(PlannedJob& job) {
    if (!job.items.empty()) {
      jobs_.push_back(std::exchange(job, PlannedJob{.is_list = job.is_list}));
    }
  }

  double limit_;
  std::vector<PlannedJob> jobs_;
  PlannedJob films_;
  std::map<std::uint64_t, PlannedJob> pairs_;  ///< by options
};

/// Many at once: reading headers is mostly waiting for a store or a disk.
std::vector<ItemCost> costs_of(const BatchJob& batch, const std::vector<ManifestItem>& items,
                               const SettingValue& options,
                               const std::function<void(int)>& progress) {
  constexpr std::size_t kReaders = 32;
  CostModel model;
  std::vector<ItemCost> costs(items.size());
  std::atomic<std::size_t> next = 0;
  std::atomic<int> done = 0;
  const auto read = [&](bool tells) {
    for (std::size_t i = next++; i < items.size(); i = next++) {
      try {
        costs[i] = model.cost_of(BatchItem(items[i], batch, options));
        ++done;
        if (tells) {
          progress(done);
        }
      } catch (...) {
        next = items.size();  // the others end
        throw;
      }
    }
  };
  std::vector<std::future<void>> readers;
  for (std::size_t i = 1; i < std::min(kReaders, items.size()); ++i) {
    readers.push_back(std::async(std::launch::async, read, false));
  }
  read(true);
  for (std::future<void>& reader : readers) {
    reader.get();
  }
  return costs;
}

}  // namespace

BatchPlan make_plan(const BatchJob& batch, const std::vector<ManifestItem>& items,
                    const SettingValue& options, const std::function<void(int)>& progress) {
  BatchPlan plan;
  plan.options = options;
  const scheduler::Machine machine = scheduler::detect_machine();
  const int threads = thread_count(batch.run.common.execution, machine);
  JobMaker jobs(batch.job_seconds * threads);
  const std::vector<ItemCost> costs = costs_of(batch, items, options, progress);
  for (std::size_t i = 0; i < items.size(); ++i) {
    const ItemCost& cost = costs[i];
    if (!cost.problem.empty()) {
      plan.problems.push_back(fmt::format("line {}: {}", items[i].line, cost.problem));
    }
    plan.frames += cost.frames;
    plan.core_seconds += cost.core_seconds;
    plan.gigabytes_in += 1e-9 * static_cast<double>(cost.bytes_in);
    plan.gigabytes_out += 1e-9 * static_cast<double>(cost.bytes_out);
    jobs.add(static_cast<int>(i), cost);
  }
  plan.jobs = jobs.finish();
  return plan;
}

std::string to_json(const BatchPlan& plan) {
  SettingValue jobs = SettingValue::array();
  for (std::size_t i = 0; i < plan.jobs.size(); ++i) {
    const PlannedJob& job = plan.jobs[i];
    SettingValue values = {{"job", i},
                           {"items", job.items},
                           {"is_list", job.is_list},
                           {"core_seconds", job.core_seconds},
                           {"memory_bytes", job.memory_bytes}};
    if (job.shard) {
      values["shard"] = {job.shard->index, job.shard->count};
    }
    jobs.push_back(std::move(values));
  }
  const SettingValue values = {
      {"manifest", plan.manifest}, {"options", plan.options}, {"jobs", std::move(jobs)}};
  return with_checksum(values.dump());
}

BatchPlan plan_from_json(const std::string& text, const std::string& name) {
  if (!has_valid_checksum(text)) {
    throw Error(fmt::format("{}: is damaged, its checksum is another", name));
  }
  try {
    const SettingValue values = parse_json(text, name);
    BatchPlan plan;
    plan.manifest = values.at("manifest").get<std::string>();
    plan.options = values.at("options");
    for (const SettingValue& job : values.at("jobs")) {
      PlannedJob& planned = plan.jobs.emplace_back();
      planned.items = job.at("items").get<std::vector<int>>();
      planned.is_list = job.at("is_list").get<bool>();
      planned.core_seconds = job.at("core_seconds").get<double>();
      planned.memory_bytes = job.at("memory_bytes").get<std::size_t>();
      if (job.contains("shard")) {
        planned.shard = Shard{job["shard"].at(0).get<int>(), job["shard"].at(1).get<int>()};
      }
    }
    return plan;
  } catch (const SettingValue::exception& error) {
    throw Error(
        fmt::format("{}: is damaged, expected the plan of a batch ({})", name, error.what()));
  }
}

}  // namespace vantage::apps
