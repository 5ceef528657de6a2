#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/options/settings.h"

namespace vantage::apps {

/// How a run is divided, and the resources its tasks request from Slurm.
struct SlurmOptions {
  int shards = 0;  ///< tasks of the job array, 1..100000; 0: not set yet
  /// Empty texts leave the choice to the cluster.
  std::string partition;
  std::string account;
  std::string time_limit;            ///< of a task, as sbatch writes it: "90", "1:30:00", "2-12"
  std::string memory;                ///< of a task: a whole number with K, M, G or T
  std::optional<int> cpus;           ///< of a task, 1..1024
  std::optional<int> concurrent;     ///< tasks at once, at least 1
  int retries = 2;                   ///< further attempts after a task has failed, 0..1000
  std::optional<int> drain_seconds;  ///< see drain_seconds_or_default(), 1..86400
  std::vector<std::string> sbatch_options;  ///< further ones, word for word: "--qos=long"
  std::string program;                      ///< the vantage program on the nodes; empty: this one

  /// Throws UsageError naming the option, its value and its limit.
  void validate() const;
  /// Time before the limit at which a task starts no more frames, finishes those in flight and is
  /// queued again: default 2 minutes, at most a quarter of the time limit.
  [[nodiscard]] int drain_seconds_or_default() const;
};

void add_slurm_settings(Settings& settings, SlurmOptions& options);

}  // namespace vantage::apps
