#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "engine/profiling/profile.h"

namespace vantage {

enum class FigureUnit { kSeconds, kBytes };

enum class Verdict {
  kNoDifference,  ///< ranges overlap
  kLess,          ///< the second needs less: it is faster, or smaller
  kMore,
  kTooFewRuns
};

/// A figure of two profiles on the same number of threads; smaller is better.
struct ComparedFigure {
  int threads = 1;
  std::string name;  ///< "wall", "compute", "stage NAME", "peak memory"
  FigureUnit unit = FigureUnit::kSeconds;
  ProfileSample first;
  ProfileSample second;
  Verdict verdict = Verdict::kNoDifference;

  /// Median of the second ÷ median of the first; 0 if undefined.
  [[nodiscard]] double ratio() const { return first.median > 0 ? second.median / first.median : 0; }
};

struct ProfileComparison {
  /// Reasons for doubt: other machines, commands, instruction sets, missing counterparts.
  std::vector<std::string> warnings;
  std::vector<ComparedFigure> figures;  ///< by threads, then wall, compute, stages, memory
};

/// Runs required on each side for a verdict.
inline constexpr int kRunsForVerdict = 3;

/// Overlapping ranges are no difference.
Verdict verdict_of(const ProfileSample& first, const ProfileSample& second);

/// Compares `second` with `first`. Thread rule: pure.
ProfileComparison compare_profiles(const Profile& first, const Profile& second);

/// "1.25x faster", "1.02x slower", "no difference seen", "too few runs"; for bytes "smaller" and
/// "larger".
std::string verdict_text(const ComparedFigure& figure);

}  // namespace vantage
