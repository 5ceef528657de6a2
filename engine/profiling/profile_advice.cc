#include "engine/profiling/profile_advice.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <utility>

#include "engine/matching/search/reduced/reduction.h"

namespace vantage {
namespace {

/// Time of `realtime` relative to that of the preset (docs/QUALITY.md).
constexpr double kRealtimeOfBalanced = 0.3;
constexpr double kRealtimeOfQuality = 0.2;

double realtime_of(MatchPreset preset) {
  switch (preset) {
    case MatchPreset::kRealtime:
      return 1;
    case MatchPreset::kBalanced:
      return kRealtimeOfBalanced;
    case MatchPreset::kQuality:
      return kRealtimeOfQuality;
  }
  return 1;
}
constexpr double kMinShare = 0.05;
/// More threads must save more than this.
constexpr double kAsFast = 1.05;
constexpr int kManyCandidates = 64;

std::string time_text(double seconds) {
  return seconds < 1 ? fmt::format("{:.0f} ms", seconds * 1e3) : fmt::format("{:.3g} s", seconds);
}

struct Advice {
  double saved_share;  ///< of the time of all steps
  std::string text;
};

class Steps {
 public:
  explicit Steps(const std::map<std::string, double>& step_s) : step_s_(step_s) {
    for (const auto& [name, seconds] : step_s) {
      sum_s_ += seconds;
    }
  }
  [[nodiscard]] double seconds(const std::string& name) const {
    const auto step = step_s_.find(name);
    return step == step_s_.end() ? 0 : step->second;
  }
  [[nodiscard]] double share(double seconds) const { return sum_s_ > 0 ? seconds / sum_s_ : 0; }
  /// "120 ms, 34 % of the time of all steps"
  [[nodiscard]] std::string text(double seconds) const {
    return fmt::format("{}, {:.0f} % of the time of all steps", time_text(seconds),
                       100 * share(seconds));
  }

 private:
  const std::map<std::string, double>& step_s_;
  double sum_s_ = 0;
};

Advice about_preset(const Steps& steps, double maps_s, const ProfiledChoices& choices) {
  // `realtime` searches few candidates at full size, and saves nothing then.
  const bool is_few = choices.candidates > 0 && choices.candidates <= kMaxFullSizeCandidates;
  if (choices.preset && (choices.preset == MatchPreset::kRealtime || is_few)) {
    return {0, ""};
  }
  if (!choices.preset) {
    return {steps.share(maps_s) * (1 - kRealtimeOfBalanced),
            fmt::format("--preset {} instead of a method of Scharstein's book: maps take {}.",
                        is_few ? "balanced" : "realtime", steps.text(maps_s))};
  }
  const double of_this = realtime_of(*choices.preset);
  return {steps.share(maps_s) * (1 - of_this),
          fmt::format(
              "--preset realtime: maps take {}; it needs about {} times that, for somewhat more "
              "bad pixels.",
              steps.text(maps_s), of_this)};
}

Advice about_range(const Steps& steps, double maps_s, const ProfiledChoices& choices) {
  if (choices.estimates_range) {
    const double range_s = steps.seconds("range");
    return {steps.share(range_s),
            fmt::format("--disparities MIN:MAX, the range that 'auto' prints: looking for it takes "
                        "{}.",
                        steps.text(range_s))};
  }
  if (choices.candidates < kManyCandidates) {
    return {0, ""};
  }
  return {steps.share(maps_s) / 4,
          fmt::format("--disparities with the exact range: {} candidates are searched in {}, and "
                      "the time grows with them; 'vantage match --disparities auto' tells which "
                      "occur.",
                      choices.candidates, steps.text(maps_s))};
}

Advice about_rows(const Steps& steps, const ProfiledChoices& choices) {
  const double check_s = choices.checks_rows ? steps.seconds("check") : 0;
  return {steps.share(check_s),
          fmt::format("--no-rectification-check, where rows are known to correspond: looking at "
                      "them takes {}.",
                      steps.text(check_s))};
}

Advice about_one_map(const Steps& steps, const ProfiledChoices& choices) {
  if (!choices.has_map_for_check_only) {
    return {0, ""};
  }
  const double other_s = std::min(steps.seconds("match left"), steps.seconds("match right"));
  return {steps.share(other_s),
          fmt::format("--cross-check none: a second map is made only to check the first, which "
                      "takes {}.",
                      steps.text(other_s))};
}

/// Advises fewer threads that are as fast, or more if available.
Advice about_threads(const Profile& profile) {
  const ThreadCountProfile& max = profile.thread_counts.back();
  const auto best = std::ranges::min_element(
      profile.thread_counts, {}, [](const ThreadCountProfile& one) { return one.wall_s.median; });
  const auto fewest = std::ranges::find_if(profile.thread_counts, [&](const auto& one) {
    return one.wall_s.median <= kAsFast * best->wall_s.median;
  });
  if (fewest->threads < max.threads) {
    return {1 - fewest->wall_s.median / max.wall_s.median + kMinShare,
            fmt::format("--threads {}: {}, with {} threads {}; further ones gain nothing for one "
                        "pair or frame.",
                        fewest->threads, time_text(fewest->wall_s.median), max.threads,
                        time_text(max.wall_s.median))};
  }
  if (max.threads < profile.hardware_threads) {
    return {kMinShare, fmt::format("--threads {}: the machine has as many, at most {} were "
                                   "measured.",
                                   profile.hardware_threads, max.threads)};
  }
  return {0, ""};
}

}  // namespace

std::vector<std::string> profile_advice(const Profile& profile,
                                        const std::map<std::string, double>& step_s,
                                        const ProfiledChoices& choices) {
  if (profile.thread_counts.empty()) {
    return {};
  }
  const Steps steps(step_s);
  const double maps_s = steps.seconds("match left") + steps.seconds("match right");
  std::vector<Advice> all = {about_preset(steps, maps_s, choices),
                             about_range(steps, maps_s, choices), about_rows(steps, choices),
                             about_one_map(steps, choices), about_threads(profile)};
  std::ranges::stable_sort(all, std::ranges::greater{}, &Advice::saved_share);
  std::vector<std::string> texts;
  for (Advice& advice : all) {
    if (advice.saved_share >= kMinShare) {
      texts.push_back(std::move(advice.text));
    }
  }
  return texts;
}

}  // namespace vantage
