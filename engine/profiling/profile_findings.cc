#include "engine/profiling/profile_findings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

#include "engine/profiling/profile_figures.h"
#include "engine/profiling/roofline.h"
#include "engine/profiling/stage_figures.h"

namespace vantage {
namespace {

constexpr double kBoundFrom = 0.5;
constexpr double kMemoryBoundFrom = 0.6;
constexpr double kMemoryBoundTo = 1.1;
constexpr double kLittleWaiting = 0.05;
constexpr double kUneven = 1.1;
constexpr double kMuchHalo = 0.05;
constexpr double kNoSerialPart = 0.001;

using Kind = ProfileFinding::Kind;
using Finding = std::optional<ProfileFinding>;

std::string percent(double share) {
  return fmt::format("{:.{}f} %", 100 * share, share < 0.0995 ? 1 : 0);
}

template <typename Named>
const Named& largest(const std::vector<Named>& all) {
  return *std::ranges::max_element(all, {},
                                   [](const Named& named) { return named.seconds.median; });
}

std::string bound_of(const StageProfile& stage, const std::optional<ThreadRoofs>& roofs) {
  if (!roofs) {
    return "What bounds it is not known: the machine's ceilings were not measured.";
  }
  const auto place = place_on_roofline(stage, *roofs);
  if (!place) {
    return "What bounds it is not known: it does not count its operations and bytes.";
  }
  const bool is_arithmetic = place->roof == Roof::kArithmetic;
  const std::string_view roof =
      is_arithmetic ? "of what the thread can calculate" : "of what its level-2 cache delivers";
  const std::string reached = percent(place->roof_share);
  if (place->roof_share >= kBoundFrom) {
    return is_arithmetic ? fmt::format("Arithmetic bounds it: {:.3g} GFLOP/s are {} {}.",
                                       place->gflops, reached, roof)
                         : fmt::format("The level-2 cache bounds it: {:.3g} GB/s are {} {}.",
                                       place->gb_per_s, reached, roof);
  }
  if (place->memory_share >= kMemoryBoundFrom && place->memory_share <= kMemoryBoundTo) {
    return fmt::format(
        "Memory may bound it: {:.3g} GB/s are {} of what memory delivers to a thread.",
        place->gb_per_s, percent(place->memory_share));
  }
  return fmt::format(
      "It reaches {} {}, so neither arithmetic nor bandwidth bounds it: what remains is waiting "
      "for results and instructions that are no arithmetic.",
      reached, roof);
}

Finding largest_stage(const ThreadCountProfile& max, const std::optional<ThreadRoofs>& roofs) {
  const double sum_s = stages_s(max);
  if (!(sum_s > 0) || !std::isfinite(sum_s)) {
    return std::nullopt;
  }
  const StageProfile& stage = largest(max.stages);
  return ProfileFinding{Kind::kStage, fmt::format("The stage \"{}\" takes {} of the {}. {}",
                                                  stage.name, percent(work_share(stage, max)),
                                                  pool_work_s(max) > 0 ? "work" : "stages' time",
                                                  bound_of(stage, roofs))};
}

Finding largest_part(const ThreadCountProfile& max) {
  const double work_s = pool_work_s(max);
  if (max.parts.empty() || !(work_s > 0) || !std::isfinite(work_s) || stages_s(max) >= work_s / 2) {
    return std::nullopt;
  }
  const PartProfile& part = largest(max.parts);
  if (!(part.seconds.median > 0) || !std::isfinite(part.seconds.median)) {
    return std::nullopt;
  }
  return ProfileFinding{
      Kind::kPart,
      fmt::format("Stages of matching are only {} of the work; the largest part of it is \"{}\" "
                  "with {:.3g} s of the threads' {:.3g} s.",
                  percent(stages_s(max) / work_s), part.name, part.seconds.median, work_s)};
}

Finding waiting(const ThreadCountProfile& max) {
  if (!(pool_time_s(max) > 0) || !std::isfinite(max.work_share.median)) {
    return std::nullopt;
  }
  const double work_share = max.work_share.median;
  const double lost = 1 - work_share;
  if (lost < kLittleWaiting) {
    return ProfileFinding{Kind::kWaiting,
                          fmt::format("Little is lost by waiting: threads work {} of the time.",
                                      percent(work_share))};
  }
  const WaitingProfile& causes = max.waiting_for;
  const std::pair<double, std::string_view> named[] = {
      {causes.reading_s.median, "while images were read or decoded"},
      {causes.computing_s.median, "for tasks of other threads"},
      {causes.writing_s.median, "while results were encoded or written"},
      {causes.nothing_s.median, "while no work was recorded: start, end, steps without tasks"}};
  const auto& [seconds, cause] = *std::ranges::max_element(named);
  std::string what;
  if (seconds > 0 && std::isfinite(seconds)) {
    what = fmt::format(", most of it ({}) {}", percent(seconds / pool_time_s(max)), cause);
  }
  return ProfileFinding{Kind::kWaiting, fmt::format("{} of the threads' time is lost waiting{}.",
                                                    percent(lost), what)};
}

Finding imbalance(const ThreadCountProfile& max) {
  const double ratio = max.imbalance.median;
  if (!(ratio >= kUneven) || !std::isfinite(ratio)) {
    return std::nullopt;
  }
  return ProfileFinding{
      Kind::kImbalance,
      fmt::format("Work is uneven: the busiest thread has {:.2f} times the mean.", ratio)};
}

Finding halo(const ThreadCountProfile& max) {
  double repeated_s = 0;
  for (const StageProfile& stage : max.stages) {
    const double share = std::max(0.0, halo_share(stage));
    repeated_s += stage.seconds.median * share / (1 + share);
  }
  const double share = repeated_s / std::max(stages_s(max), 1e-12);
  if (!(share >= kMuchHalo) || !std::isfinite(share)) {
    return std::nullopt;
  }
  return ProfileFinding{
      Kind::kHalo,
      fmt::format("{} of the stages' time makes columns again: halos of strips, rows that "
                  "warm up sums, first stages of later passes.",
                  percent(share))};
}

Finding scaling(const Profile& profile) {
  if (profile.speed_ups.size() < 2) {
    return std::nullopt;
  }
  const SpeedUp& speed_up = profile.speed_ups.back();
  if (!std::isfinite(speed_up.ratio.median) || !std::isfinite(speed_up.efficiency)) {
    return std::nullopt;
  }
  const int fewest = profile.speed_ups.front().threads;
  const std::string fewest_threads = fewest == 1 ? "one" : std::to_string(fewest);
  const std::string measured =
      fmt::format("{} threads are {:.2f} times as fast as {} (efficiency {})", speed_up.threads,
                  speed_up.ratio.median, fewest_threads, percent(speed_up.efficiency));
  if (!profile.serial_fraction || !std::isfinite(*profile.serial_fraction)) {
    return ProfileFinding{Kind::kScaling, measured + "."};
  }
  const double serial = *profile.serial_fraction;
  if (serial < kNoSerialPart) {
    return ProfileFinding{Kind::kScaling, measured + "; no serial part is to be seen."};
  }
  if (serial >= 1) {
    return ProfileFinding{Kind::kScaling, measured + "; more threads are not faster."};
  }
  return ProfileFinding{
      Kind::kScaling,
      fmt::format("{}, which implies a serial part of {}: more threads could make it at most "
                  "{:.3g} times as fast as {}.",
                  measured, percent(serial), 1 / serial, fewest_threads)};
}

}  // namespace

std::vector<ProfileFinding> profile_findings(const Profile& profile) {
  std::vector<ProfileFinding> findings;
  if (profile.thread_counts.empty()) {
    return findings;
  }
  const ThreadCountProfile& max = profile.thread_counts.back();
  for (const Finding& finding :
       {largest_stage(max, roofs_on(profile, max.threads)), largest_part(max), waiting(max),
        imbalance(max), halo(max), scaling(profile)}) {
    if (finding) {
      findings.push_back(*finding);
    }
  }
  return findings;
}

}  // namespace vantage
