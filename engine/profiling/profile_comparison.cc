#include "engine/profiling/profile_comparison.h"

#include <fmt/format.h>

#include <algorithm>

namespace vantage {
namespace {

void warn_if_different(std::string_view what, const std::string& first, const std::string& second,
                       std::vector<std::string>& warnings) {
  if (first != second) {
    warnings.push_back(fmt::format("{} differs: {} and {}", what, first, second));
  }
}

std::string thread_counts_text(const Profile& profile) {
  std::string text;
  for (const ThreadCountProfile& count : profile.thread_counts) {
    text += (text.empty() ? "" : ", ") + std::to_string(count.threads);
  }
  return text;
}

void compare(const ThreadCountProfile& first, const ThreadCountProfile& second,
             ProfileComparison& comparison) {
  const bool enough = std::min(first.runs, second.runs) >= kRunsForVerdict;
  const auto add = [&](std::string name, FigureUnit unit, const ProfileSample& a,
                       const ProfileSample& b) {
    comparison.figures.push_back({.threads = first.threads,
                                  .name = std::move(name),
                                  .unit = unit,
                                  .first = a,
                                  .second = b,
                                  .verdict = enough ? verdict_of(a, b) : Verdict::kTooFewRuns});
  };
  add("wall", FigureUnit::kSeconds, first.wall_s, second.wall_s);
  add("compute", FigureUnit::kSeconds, first.compute_s, second.compute_s);
  for (const StageProfile& stage : first.stages) {
    const auto other = std::ranges::find(second.stages, stage.name, &StageProfile::name);
    if (other == second.stages.end()) {
      comparison.warnings.push_back(
          fmt::format("stage {} is in the first alone, on {} threads", stage.name, first.threads));
    } else {
      add("stage " + stage.name, FigureUnit::kSeconds, stage.seconds, other->seconds);
    }
  }
  for (const StageProfile& stage : second.stages) {
    if (std::ranges::find(first.stages, stage.name, &StageProfile::name) == first.stages.end()) {
      comparison.warnings.push_back(
          fmt::format("stage {} is in the second alone, on {} threads", stage.name, first.threads));
    }
  }
  add("peak memory", FigureUnit::kBytes, first.peak_memory_bytes, second.peak_memory_bytes);
}

}  // namespace

Verdict verdict_of(const ProfileSample& first, const ProfileSample& second) {
  if (second.max < first.min) {
    return Verdict::kLess;
  }
  return second.min > first.max ? Verdict::kMore : Verdict::kNoDifference;
}

ProfileComparison compare_profiles(const Profile& first, const Profile& second) {
  ProfileComparison comparison;
  std::vector<std::string>& warnings = comparison.warnings;
  warn_if_different("the processor", first.processor, second.processor, warnings);
  warn_if_different("the number of hardware threads", std::to_string(first.hardware_threads),
                    std::to_string(second.hardware_threads), warnings);
  warn_if_different("the instruction set", first.isa, second.isa, warnings);
  warn_if_different("the command", first.command, second.command, warnings);
  warn_if_different("the numbers of threads", thread_counts_text(first), thread_counts_text(second),
                    warnings);
  for (const ThreadCountProfile& count : first.thread_counts) {
    const auto other =
        std::ranges::find(second.thread_counts, count.threads, &ThreadCountProfile::threads);
    if (other != second.thread_counts.end()) {
      compare(count, *other, comparison);
    }
  }
  return comparison;
}

std::string verdict_text(const ComparedFigure& figure) {
  const bool is_time = figure.unit == FigureUnit::kSeconds;
  switch (figure.verdict) {
    case Verdict::kLess:
      return figure.second.median > 0
                 ? fmt::format("{:.2f}x {}", figure.first.median / figure.second.median,
                               is_time ? "faster" : "smaller")
                 : "gone";
    case Verdict::kMore:
      return figure.first.median > 0
                 ? fmt::format("{:.2f}x {}", figure.ratio(), is_time ? "slower" : "larger")
                 : "new";
    case Verdict::kTooFewRuns:
      return "too few runs";
    case Verdict::kNoDifference:
      break;
  }
  return "no difference seen";
}

}  // namespace vantage
