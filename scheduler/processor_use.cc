#include "scheduler/processor_use.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <ctime>
#include <fstream>
#include <string>

namespace vantage::scheduler {

ProcessorUse::ProcessorUse() : begin_(now()) {}

std::optional<ProcessorUse::Moment> ProcessorUse::now() {
  // user, nice, system, idle, iowait, irq, softirq, steal; all processors together.
  constexpr std::size_t kIdle = 3;
  constexpr std::size_t kWaiting = 4;
  std::ifstream stat("/proc/stat");
  std::string name;
  std::array<double, 8> ticks{};
  stat >> name;
  for (double& kind : ticks) {
    stat >> kind;
  }
  const long ticks_per_s = ::sysconf(_SC_CLK_TCK);
  timespec own{};
  if (!stat || name != "cpu" || ticks_per_s <= 0 ||
      ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &own) != 0) {
    return std::nullopt;
  }
  Moment moment;
  for (std::size_t kind = 0; kind < ticks.size(); ++kind) {
    moment.all_busy_s += kind == kIdle || kind == kWaiting ? 0 : ticks[kind];
  }
  moment.all_busy_s /= static_cast<double>(ticks_per_s);
  moment.own_busy_s = static_cast<double>(own.tv_sec) + 1e-9 * static_cast<double>(own.tv_nsec);
  moment.clock_s =
      std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
  return moment;
}

std::optional<double> ProcessorUse::of_others() const {
  const std::optional<Moment> end = begin_ ? now() : std::nullopt;
  if (!end || end->clock_s <= begin_->clock_s) {
    return std::nullopt;
  }
  const double others_s =
      (end->all_busy_s - begin_->all_busy_s) - (end->own_busy_s - begin_->own_busy_s);
  return std::max(0.0, others_s / (end->clock_s - begin_->clock_s));
}

}  // namespace vantage::scheduler
