#pragma once

#include <string>
#include <vector>

#include "engine/profiling/profile.h"

namespace vantage {

/// A sentence about where the threads of a profile, at their largest count, spend their time.
struct ProfileFinding {
  enum class Kind {
    kStage,      ///< the stage with most of the work, and its bound
    kPart,       ///< the largest part, if stages are less than half of the work
    kWaiting,    ///< the share of the threads' time lost by waiting, and its cause
    kImbalance,  ///< one thread of the pool works at least a tenth more than the mean
    kHalo,       ///< at least 5 % of the stages' time is repeated work
    kScaling     ///< speed-up, and the serial fraction that it implies
  };
  Kind kind;
  std::string text;  ///< plain text
};

/// What limits a command according to the figures, in the order of the kinds, one of each kind. A
/// kind whose figures are missing, or below its threshold above, is omitted; nothing is guessed.
///
/// A stage is bound by its roof from half of it on. Below, it is memory-bound if it moves between
/// 60 % and 110 % of the memory bandwidth; else neither.
std::vector<ProfileFinding> profile_findings(const Profile& profile);

}  // namespace vantage
