#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>

namespace vantage::scheduler {

/// What Linux lets this process have. Control groups (cgroups, versions 1 and 2) limit processor
/// time and memory: every group from that of the process up to the root counts.
struct SystemLimits {
  /// Processors' worth of time, the least quota of all groups; empty: no group has one.
  std::optional<double> processors = std::nullopt;
  std::size_t memory_bytes = 0;  ///< least of MemTotal and the groups' limits; 0: unknown
  /// Of it, what is not in use, or caches files and gives way; 0: unknown.
  std::size_t free_bytes = 0;

  /// Threads that the quota keeps busy: rounded up, at least 1, at most `threads`.
  [[nodiscard]] int threads_of(int threads) const;
};

/// Reads proc and sys/fs/cgroup in `root`; what cannot be read limits nothing. Thread rule: may be
/// called concurrently.
SystemLimits read_system_limits(const std::filesystem::path& root = "/");

}  // namespace vantage::scheduler
