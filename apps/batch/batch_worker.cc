#include "apps/batch/batch_worker.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <random>
#include <thread>

#include "apps/process/tell.h"
#include "engine/error.h"

namespace vantage::apps {
namespace {

/// Holders that died before a job is given up: it may be what ends them.
constexpr int kMaxAbandoned = 20;

}  // namespace

std::string name_of_job(std::size_t job) { return fmt::format("{:06}", job); }
std::string name_of_merge(int item) { return fmt::format("merge-{:06}", item); }

BatchWorker::BatchWorker(const BatchJob& batch, const BatchPlan& plan, BatchState& state,
                         Leases& leases, JobRunner& runner, const std::atomic<bool>& stop,
                         OnJob on_job)
    : batch_(batch),
      plan_(plan),
      state_(state),
      leases_(leases),
      runner_(runner),
      stop_(stop),
      on_job_(std::move(on_job)) {
  for (std::size_t i = 0; i < plan.jobs.size(); ++i) {
    const PlannedJob& job = plan.jobs[i];
    names_.push_back(name_of_job(i));
    job_of_[names_.back()] = i;
    if (job.shard) {
      parts_[name_of_merge(job.items.front())].push_back(names_.back());
    }
  }
  for (const auto& [name, parts] : parts_) {
    names_.push_back(name);
  }
  // Workers that begin at different places rarely want the same job.
  first_ = std::random_device()() % names_.size();
}

bool BatchWorker::is_own(const std::string& name) const {
  if (!batch_.task) {
    return true;
  }
  if (const auto parts = parts_.find(name); parts != parts_.end()) {
    return std::ranges::any_of(parts->second,
                               [&](const std::string& part) { return is_own(part); });
  }
  const auto count = static_cast<std::size_t>(batch_.task->count);
  return job_of_.at(name) % count + 1 == static_cast<std::size_t>(batch_.task->index);
}

bool BatchWorker::is_ready(const std::string& name) const {
  const auto parts = parts_.find(name);
  return parts == parts_.end() || std::ranges::all_of(parts->second, [&](const std::string& part) {
           return done_.contains(part);
         });
}

std::vector<ItemResult> BatchWorker::join_parts(const std::string& name) {
  const std::vector<std::string>& parts = parts_.at(name);
  ItemResult whole{.item = plan_.jobs[job_of_.at(parts.front())].items.front(), .attempts = 0};
  for (const std::string& part : parts) {
    for (const ItemResult& result : state_.results(part)) {
      if (result.failed && !whole.failed) {
        whole.failed = true;
        whole.problem = result.problem;
        whole.command = result.command;
      }
      whole.frames += result.frames;
      whole.skipped += result.skipped;
      whole.seconds += result.seconds;
      whole.core_seconds += result.core_seconds;
      whole.attempts = std::max(whole.attempts, result.attempts);
    }
  }
  if (whole.failed) {
    return {whole};  // there is nothing to join
  }
  const std::optional<ItemResult> joined = runner_.join(whole.item, name);
  if (!joined) {
    return {};
  }
  whole.failed = joined->failed;
  whole.problem = joined->problem;
  whole.command = joined->command;
  return {whole};
}

void BatchWorker::do_job(Lease& lease) {
  const auto parts = parts_.find(lease.name());
  const bool is_joining = parts != parts_.end();
  const PlannedJob& job = plan_.jobs[job_of_.at(is_joining ? parts->second.front() : lease.name())];
  std::vector<ItemResult> results;
  if (lease.abandoned() >= kMaxAbandoned) {
    for (const int item : job.items) {
      results.push_back({.item = item, .failed = true});
      results.back().problem = fmt::format("{} workers died that had begun it", lease.abandoned());
    }
  } else if (is_joining) {
    results = join_parts(lease.name());
  } else {
    results = state_.results(lease.name());
    runner_.run(job, lease.name(), results, [&] { state_.keep_progress(lease.name(), results); });
  }
  if (results.size() < job.items.size()) {
    lease.hand_back();  // stopped
    return;
  }
  state_.finish(lease.name(), results);
  lease.finish();
  done_.insert(lease.name());
  on_job_(lease.name(), results);
}

BatchWorker::Pass BatchWorker::pass() {
  leases_.look();
  done_ = state_.done();
  bool is_left = false;
  for (std::size_t i = 0; i < names_.size(); ++i) {
    const std::string& name = names_[(first_ + i) % names_.size()];
    if (done_.contains(name) || !is_own(name)) {
      continue;
    }
    if (!is_ready(name)) {
      is_left = is_left || !batch_.task;  // parts of other tasks are theirs to join
      continue;
    }
    const std::unique_ptr<Lease> lease = leases_.take(name);
    if (lease == nullptr) {
      is_left = true;
      continue;
    }
    if (state_.is_done(name)) {
      lease->finish();  // since we looked
      done_.insert(name);
      continue;
    }
    try {
      do_job(*lease);
    } catch (const std::exception&) {
      lease->hand_back();
      throw;
    }
    return Pass::kWorked;
  }
  return is_left ? Pass::kNothingFree : Pass::kNothingLeft;
}

void BatchWorker::wait() const {
  constexpr std::chrono::milliseconds kStep{100};
  constexpr double kLongest_s = 5;
  const auto end = std::chrono::steady_clock::now() +
                   std::chrono::duration<double>(std::min(kLongest_s, batch_.lease_seconds / 4));
  while (!stop_.load() && std::chrono::steady_clock::now() < end) {
    std::this_thread::sleep_for(kStep);
  }
}

WorkerEnding BatchWorker::run() {
  while (!stop_.load()) {
    const Pass made = pass();
    if (made == Pass::kNothingLeft) {
      break;
    }
    if (made == Pass::kNothingFree) {
      wait();
    }
  }
  return {.interrupted = stop_.load(),
          .all_done = std::ranges::all_of(
              names_, [&](const std::string& name) { return done_.contains(name); })};
}

}  // namespace vantage::apps
