#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "apps/submit/array_job.h"
#include "engine/options/settings.h"

namespace vantage::apps {

/// In the order of engines().
enum class BatchEngine { kSlurm, kSge, kKubernetes, kAwsBatch, kLocal };

/// Where tasks run, and what they request. Empty texts leave the choice to the engine.
struct SubmitOptions {
  BatchEngine engine = BatchEngine::kSlurm;
  bool go = false;  ///< submit; else only write

  int shards = 0;              ///< of a run that is divided, 1..100000; 0: not set
  std::optional<int> tasks;    ///< of a manifest
  ArrayJob requests;           ///< of a task; only what options say
  std::optional<int> drain_s;  ///< see drain_s_or_default()
  std::string program;         ///< vantage where tasks run; empty: this one, or that of the image

  // Of some engines; the table of engines says which.
  std::string partition;
  std::string account;
  std::string queue;
  std::string parallel_environment = "smp";
  std::string memory_resource = "mem_free";
  std::vector<std::string> sbatch_options;  ///< word for word: "--qos=long"
  std::vector<std::string> qsub_options;    ///< word for word: "-l arch=lx-amd64"
  std::string image;
  std::string service_account;
  std::vector<std::string> volume_claims;  ///< "NAME:/path"
  std::string job_role;
  std::string execution_role;

  /// Throws UsageError naming the option, its value and its limit.
  void validate() const;
  /// Time in which a task that has to end finishes what is in flight: default that of the engine,
  /// at most a quarter of the time limit.
  [[nodiscard]] int drain_s_or_default() const;
};

void add_submit_settings(Settings& settings, SubmitOptions& options);

/// DAYS-HOURS:MINUTES:SECONDS, without the days if there are none.
std::string duration_text(long seconds);

}  // namespace vantage::apps
