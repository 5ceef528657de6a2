#include "apps/batch/batch_run.h"

#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <memory>
#include <mutex>
#include <random>
#include <thread>

#include "apps/batch/batch_plan.h"
#include "apps/batch/batch_report.h"
#include "apps/batch/batch_state.h"
#include "apps/batch/batch_worker.h"
#include "apps/batch/job_runner.h"
#include "apps/commands/commands.h"
#include "apps/process/child_process.h"
#include "apps/process/interrupt.h"
#include "apps/process/outputs.h"
#include "apps/process/progress.h"
#include "apps/process/scratch_folder.h"
#include "apps/process/tell.h"
#include "apps/reports/run_report.h"
#include "engine/error.h"
#include "engine/io/files/atomic_file.h"
#include "engine/io/files/checksum.h"
#include "engine/io/files/file_bytes.h"
#include "engine/io/files/remote_files.h"
#include "engine/io/store/lease.h"
#include "engine/io/store/opened_store.h"
#include "engine/seconds_since.h"
#include "engine/sequence/options/sequence_layout.h"
#include "scheduler/interruption.h"

namespace vantage::apps {
namespace {

namespace fs = std::filesystem;

constexpr const char* kItemLines = "items.jsonl";

/// Of this worker, for people who look at leases.
std::string name_of_worker() {
  std::array<char, 256> host = {};
  ::gethostname(host.data(), host.size() - 1);
  // Hosts of containers may have one name, and all processes the number 1.
  return fmt::format("{} process {} ({:08x})", host.data(), ::getpid(), std::random_device()());
}

std::string identity_of(const std::string& manifest) {
  const std::vector<std::uint8_t> bytes = read_file_bytes(manifest);
  return fmt::format("{} bytes, crc32 {:08x}", bytes.size(), crc32_of(bytes));
}

void check_files(const BatchJob& job, const Settings& settings) {
  FileChecks files(settings);
  files.add_output(job.run.common.report, "--report", OutputKind::kText);
  files.add_output(job.metrics, "--metrics", OutputKind::kText);
}

/// After a signal the store is still needed, to hand back what was begun.
class EndOfGrace {
 public:
  EndOfGrace(const std::atomic<bool>& stop, double grace_s)
      : stop_(stop),
        grace_s_(grace_s),
        seen_(std::make_shared<std::once_flag>()),
        since_(std::make_shared<std::chrono::steady_clock::time_point>()) {}
  bool operator()() const {
    if (!stop_.load()) {
      return false;
    }
    std::call_once(*seen_, [this] { *since_ = std::chrono::steady_clock::now(); });
    return seconds_since(*since_) > grace_s_;
  }

 private:
  const std::atomic<bool>& stop_;
  double grace_s_;
  std::shared_ptr<std::once_flag> seen_;
  std::shared_ptr<std::chrono::steady_clock::time_point> since_;
};

/// A batch as one process works on it.
class BatchSession {
 public:
  BatchSession(BatchJob& job, const Settings& settings)
      : job_(job),
        settings_(settings),
        report_(settings.command(), settings.values()),
        stop_(interrupt_flag()),
        items_(read_manifest(job.manifest)),
        options_(options_of_all(settings)),
        joins_(job.worker || job.task),
        is_remote_(is_address(job.run.output)) {}

  int run() {
    if (job_.run.dry_run) {
      const BatchPlan plan = plan_now();
      fmt::print("{}", describe_plan(plan, job_, items_.size()));
      report_.set_results(plan_values(plan));
      report_.write(job_.run.common.report);
      return kExitDone;
    }
    store_ = open_store(job_.run.output, EndOfGrace(stop_, job_.grace_seconds));
    if (store_->info(".vantage/run.json")) {
      throw Error(fmt::format("{}: holds a run, expected a folder for a batch", job_.run.output));
    }
    state_ = std::make_unique<BatchState>(*store_);
    leases_ = std::make_unique<Leases>(*store_, std::string(BatchState::kPrefix) + "leases/",
                                       name_of_worker(),
                                       std::chrono::duration<double>(job_.lease_seconds));
    const std::optional<BatchPlan> plan = plan_in_force();
    if (!plan) {
      return ending_of_interrupt();
    }
    if (is_remote_ && joins_ && !state_->excludes()) {
      throw Error(
          fmt::format("{}: this store replaces objects in spite of If-None-Match, so that "
                      "workers would take the same jobs; expected one that does not",
                      job_.run.output));
    }
    if (job_.retry_failed) {
      reopen_failed(*plan);
    }
    return work(*plan);
  }

 private:
  [[nodiscard]] int ending_of_interrupt() const {
    return joins_ ? kExitTryAgain : kExitInterrupted;
  }

  BatchPlan plan_now() {
    Progress progress("batch: looking at inputs", "items", job_.run.shown_progress());
    BatchPlan plan = make_plan(job_, items_, options_, [&](int done) {
      progress.update(done, static_cast<int>(items_.size()), 0);
      if (stop_.load()) {
        throw scheduler::Interrupted();
      }
    });
    plan.manifest = identity_of(job_.manifest);
    return plan;
  }

  /// Throws Error where the folder holds another batch.
  BatchPlan checked(BatchPlan plan) {
    if (plan.manifest != identity_of(job_.manifest)) {
      throw Error(fmt::format("{}: holds a batch of another manifest ({}), expected {}",
                              job_.run.output, plan.manifest, job_.manifest));
    }
    if (!options_.empty() && options_ != plan.options) {
      throw Error(fmt::format("{}: holds a batch with other options: {}", job_.run.output,
                              plan.options.dump()));
    }
    options_ = plan.options;
    return plan;
  }

  /// That of the folder, else one that is made now, by one worker alone. Empty when interrupted.
  std::optional<BatchPlan> plan_in_force() {
    while (!stop_.load()) {
      if (std::optional<BatchPlan> plan = state_->read_plan()) {
        if (!joins_ && !job_.run.resume && !job_.retry_failed && !is_new_) {
          throw Error(fmt::format(
              "{}: holds a batch already, expected --resume to go on with it, or another folder",
              job_.run.output));
        }
        return checked(std::move(*plan));
      }
      check_items(job_, items_, options_);
      if (!is_remote_) {
        make_folder(job_.run.output);
      }
      leases_->look();
      if (const std::unique_ptr<Lease> lease = leases_->take("plan")) {
        is_new_ = true;
        make_and_keep_plan(*lease);
      } else {
        std::this_thread::sleep_for(std::chrono::milliseconds(200));
      }
    }
    return std::nullopt;
  }

  void make_and_keep_plan(Lease& lease) {
    try {
      const BatchPlan plan = plan_now();
      (void)state_->keep_plan(plan);
      lease.finish();
      if (!job_.run.common.quiet) {
        tell("{}", describe_plan(plan, job_, items_.size()));
      }
    } catch (...) {
      lease.hand_back();
      throw;
    }
  }

  /// Of jobs, and of the items whose parts they are.
  void reopen_failed(const BatchPlan& plan) {
    for (std::size_t i = 0; i < plan.jobs.size(); ++i) {
      const std::string name = name_of_job(i);
      std::vector<ItemResult> results = state_->results(name);
      const auto failed = std::erase_if(results, [](const auto& one) { return one.failed; });
      if (failed == 0) {
        continue;
      }
      state_->keep_progress(name, results);
      if (plan.jobs[i].shard) {
        state_->reopen(name_of_merge(plan.jobs[i].items.front()));
      }
      state_->reopen(name);
    }
    for (const PlannedJob& job : plan.jobs) {
      if (!job.shard || job.shard->index > 1) {
        continue;
      }
      const std::string name = name_of_merge(job.items.front());
      const std::vector<ItemResult> joined = state_->results(name);
      if (!joined.empty() && joined.front().failed) {
        state_->reopen(name);
      }
    }
  }

  int work(const BatchPlan& plan) {
    BatchTotals totals;
    std::optional<ScratchFolder> scratch;
    fs::path work = fs::path(job_.run.output) / BatchState::kPrefix / "work";
    if (is_remote_) {
      const fs::path wanted =
          job_.scratch.empty() ? fs::temp_directory_path() : fs::path(job_.scratch);
      work = scratch.emplace(wanted / "batch").path();
    }
    JobRunner runner(job_, items_, options_, *store_, work, stop_);
    BatchWorker worker(job_, plan, *state_, *leases_, runner, stop_,
                       [&](const std::string& name, const std::vector<ItemResult>& results) {
                         tell_job(name, results, worker, totals);
                       });
    const WorkerEnding ending = worker.run();
    if (ending.all_done) {
      return finish(plan);
    }
    report_.set_results({{"jobs", plan.jobs.size()},
                         {"items_done", totals.done},
                         {"items_failed", totals.failed},
                         {"interrupted", ending.interrupted}});
    report_.write(job_.run.common.report);
    if (ending.interrupted) {
      if (!job_.run.common.quiet) {
        tell("batch: interrupted, what was begun is handed back\n");
      }
      return ending_of_interrupt();
    }
    return totals.failed > 0 ? kExitSkipped : kExitDone;
  }

  void tell_job(const std::string& name, const std::vector<ItemResult>& results,
                const BatchWorker& worker, BatchTotals& totals) {
    BatchTotals of_job;
    for (const ItemResult& result : results) {
      of_job.add(result);
      totals.add(result);
    }
    if (!job_.metrics.empty()) {
      write_text_file(job_.metrics,
                      metrics_text(totals, worker.done().size(), worker.names().size()));
    }
    if (!job_.run.common.quiet) {
      tell("batch: job {}: {} done{}; {} of {} jobs are done\n", name, of_job.done,
           of_job.failed > 0 ? fmt::format(", {} failed", of_job.failed) : "", worker.done().size(),
           worker.names().size());
    }
  }

  int finish(const BatchPlan& plan) {
    const std::vector<ItemResult> results = item_results(plan, *state_);
    const std::string lines = joined_path(job_.run.output, kItemLines).string();
    (void)store_->put_text(kItemLines, item_lines(items_, results));
    BatchTotals totals;
    for (const ItemResult& result : results) {
      totals.add(result);
    }
    report_.set_results({{"jobs", plan.jobs.size()},
                         {"items_done", totals.done},
                         {"items_failed", totals.failed},
                         {"frames", totals.frames},
                         {"core_seconds", totals.core_seconds}});
    report_.write(job_.run.common.report);
    if (!job_.run.common.quiet) {
      tell("{}batch: all items are in {}\n", describe_results(items_, results), lines);
    }
    return totals.failed > 0 ? kExitSkipped : kExitDone;
  }

  BatchJob& job_;
  const Settings& settings_;
  RunReport report_;
  const std::atomic<bool>& stop_;
  std::vector<ManifestItem> items_;
  SettingValue options_;
  bool joins_;
  bool is_remote_;       ///< the output is an address
  bool is_new_ = false;  ///< this process made the plan
  std::unique_ptr<ObjectStore> store_;
  std::unique_ptr<BatchState> state_;
  std::unique_ptr<Leases> leases_;
};

}  // namespace

int run_batch(BatchJob& job, const Settings& settings) {
  check_batch(job, settings);
  check_files(job, settings);
  end_children_with_this();
  return BatchSession(job, settings).run();
}

}  // namespace vantage::apps
