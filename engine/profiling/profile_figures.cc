#include "engine/profiling/profile_figures.h"

#include <algorithm>
#include <cstddef>

namespace vantage {

ProfileSample sample_of(std::vector<double> values) {
  if (values.empty()) {
    return {};
  }
  std::ranges::sort(values);
  const std::size_t middle = values.size() / 2;
  const double median =
      values.size() % 2 == 1 ? values[middle] : (values[middle - 1] + values[middle]) / 2;
  return {median, values.front(), values.back()};
}

double karp_flatt(double speed_up, double processors) {
  return (1 / speed_up - 1 / processors) / (1 - 1 / processors);
}

std::vector<SpeedUp> speed_ups(std::span<const WallTimes> times) {
  std::vector<SpeedUp> all;
  for (const WallTimes& one : times) {
    const WallTimes& first = times.front();
    std::vector<double> ratios;
    for (std::size_t round = 0; round < one.wall_s.size(); ++round) {
      ratios.push_back(first.wall_s[round] / one.wall_s[round]);
    }
    SpeedUp& speed_up = all.emplace_back();
    speed_up.threads = one.threads;
    speed_up.ratio = sample_of(ratios);
    const double processors = static_cast<double>(one.threads) / first.threads;
    speed_up.efficiency = speed_up.ratio.median / processors;
    if (processors > 1 && speed_up.ratio.median > 0) {
      speed_up.serial_fraction = karp_flatt(speed_up.ratio.median, processors);
    }
  }
  return all;
}

std::optional<double> amdahl_fit(std::span<const SpeedUp> speed_ups) {
  double xy = 0;
  double xx = 0;
  for (const SpeedUp& one : speed_ups) {
    const double processors = static_cast<double>(one.threads) / speed_ups.front().threads;
    if (one.ratio.median > 0) {
      // 1/ψ − 1/p = s · (1 − 1/p)
      const double x = 1 - 1 / processors;
      xy += x * (1 / one.ratio.median - 1 / processors);
      xx += x * x;
    }
  }
  return xx > 0 ? std::optional(xy / xx) : std::nullopt;
}

std::vector<ProcessorGrowth> processor_growth(const Profile& profile) {
  constexpr double kMinShare = 0.005;
  std::vector<ProcessorGrowth> all;
  const auto add = [&](const char* kind, auto entries, auto seconds, double min_s) {
    for (const auto& first : profile.thread_counts.front().*entries) {
      ProcessorGrowth one{first.name, kind, {}, {}};
      for (const ThreadCountProfile& count : profile.thread_counts) {
        const auto here = std::ranges::find(count.*entries, first.name,
                                            [](const auto& entry) { return entry.name; });
        const double all_s = here == (count.*entries).end() ? 0 : ((*here).*seconds).median;
        one.ms.push_back(1e3 * all_s / std::max(1.0, count.frames));
        one.growth.push_back(one.ms.front() > 0 ? one.ms.back() / one.ms.front() - 1 : 0);
      }
      const auto is_known = [&](const ProcessorGrowth& other) { return other.name == one.name; };
      if ((first.*seconds).median > min_s && std::ranges::none_of(all, is_known)) {
        all.push_back(std::move(one));
      }
    }
  };
  if (!profile.thread_counts.empty()) {
    double min_s = 0;
    for (const PartProfile& part : profile.thread_counts.front().parts) {
      min_s += kMinShare * part.processor_s.median;
    }
    add("step", &ThreadCountProfile::frame_steps, &PartProfile::processor_s, 0);
    add("part", &ThreadCountProfile::parts, &PartProfile::processor_s, min_s);
    add("stage", &ThreadCountProfile::stages, &StageProfile::seconds, min_s);
  }
  return all;
}

double stages_s(const ThreadCountProfile& count) {
  double result = 0;
  for (const StageProfile& stage : count.stages) {
    result += stage.seconds.median;
  }
  return result;
}

double pool_work_s(const ThreadCountProfile& count) {
  double result = 0;
  for (const ThreadProfile& worker : count.workers) {
    result += worker.is_in_pool ? worker.work_s : 0;
  }
  return result;
}

double pool_time_s(const ThreadCountProfile& count) {
  double result = 0;
  for (const ThreadProfile& worker : count.workers) {
    result += worker.is_in_pool ? worker.work_s + worker.wait_s : 0;
  }
  return result;
}

}  // namespace vantage
