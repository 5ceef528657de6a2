#include "scheduler/control_groups.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>
#include <string>
#include <string_view>

namespace vantage::scheduler {
namespace {

namespace fs = std::filesystem;

/// Version 1 writes about 2⁶³ where there is no limit, version 2 "max", which is no number.
constexpr double kNoLimit_bytes = 0x1p60;

std::optional<double> number_in(const fs::path& file) {
  std::ifstream stream(file);
  double number = 0;
  return stream >> number ? std::optional(number) : std::nullopt;
}

/// The number after `key` in a file of lines "key number".
std::optional<double> entry(const fs::path& file, std::string_view key) {
  std::ifstream stream(file);
  for (std::string line; std::getline(stream, line);) {
    std::istringstream words(line);
    std::string word;
    double number = 0;
    if (words >> word >> number && word == key) {
      return number;
    }
  }
  return std::nullopt;
}

void lower(std::size_t& bytes, double limit) {
  const auto whole = static_cast<std::size_t>(std::max(limit, 1.0));
  bytes = bytes == 0 ? whole : std::min(bytes, whole);
}

/// Takes the limits of a group, of either version.
void take(SystemLimits& limits, const fs::path& group) {
  std::ifstream maximum(group / "cpu.max");
  double quota = number_in(group / "cpu.cfs_quota_us").value_or(-1);
  double period = number_in(group / "cpu.cfs_period_us").value_or(1);
  maximum >> quota >> period;
  if (quota > 0 && period > 0) {
    limits.processors = std::min(limits.processors.value_or(quota / period), quota / period);
  }
  auto limit = number_in(group / "memory.limit_in_bytes");
  const bool is_first = limit.has_value();
  limit = is_first ? limit : number_in(group / "memory.max");
  if (limit && *limit < kNoLimit_bytes) {
    const auto used = number_in(group / (is_first ? "memory.usage_in_bytes" : "memory.current"));
    const auto cache =
        entry(group / "memory.stat", is_first ? "total_inactive_file" : "inactive_file");
    lower(limits.memory_bytes, *limit);
    lower(limits.free_bytes, *limit - std::max(used.value_or(0) - cache.value_or(0), 0.0));
  }
}

/// Takes the limits of `group` and of all above it. In a container the path is often that of the
/// host, and `hierarchy` shows the container's group.
void take_all(SystemLimits& limits, const fs::path& hierarchy, fs::path group) {
  for (; group.has_relative_path(); group = group.parent_path()) {
    take(limits, hierarchy / group.relative_path());
  }
  take(limits, hierarchy);
}

}  // namespace

int SystemLimits::threads_of(int threads) const {
  return processors ? std::clamp(static_cast<int>(std::ceil(*processors)), 1, threads) : threads;
}

SystemLimits read_system_limits(const fs::path& root) {
  SystemLimits limits;
  constexpr double kKib = 1024;
  if (const auto total = entry(root / "proc/meminfo", "MemTotal:")) {
    lower(limits.memory_bytes, *total * kKib);
    lower(limits.free_bytes, entry(root / "proc/meminfo", "MemAvailable:").value_or(*total) * kKib);
  }
  std::ifstream groups(root / "proc/self/cgroup");
  for (std::string line; std::getline(groups, line);) {
    // NUMBER:CONTROLLER[,CONTROLLER...]:GROUP; version 2 names no controllers.
    std::istringstream fields(line);
    std::string controllers;
    std::string group;
    std::getline(fields, controllers, ':');
    std::getline(fields, controllers, ':');
    std::getline(fields, group);
    std::istringstream names(controllers + ',');
    for (std::string controller; std::getline(names, controller, ',');) {
      take_all(limits, root / "sys/fs/cgroup" / controller, group);
    }
  }
  return limits;
}

}  // namespace vantage::scheduler
