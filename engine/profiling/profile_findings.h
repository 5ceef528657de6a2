#pragma once

#include <string>
#include <vector>

#include "engine/profiling/profile.h"

namespace vantage {

/// A sentence about what the most threads of a profile spend their time on.
struct ProfileFinding {
  enum class Kind {
    kStage,      ///< the stage that takes most of the work, and what bounds it
    kPart,       ///< the largest part, where stages are less than half of the work
    kWaiting,    ///< the share of the threads' time that is lost waiting, and for what
    kImbalance,  ///< one thread of the pool works at least a tenth more than the mean
    kHalo,       ///< at least 5 % of the stages' time goes into what is made again
    kScaling     ///< speed-up, and the serial fraction that it implies
  };
  Kind kind;
  std::string text;  ///< plain
};

/// What the figures say holds a command back, in the order of the kinds, one of a kind. A kind
/// whose figures are missing, or too small by the rule above, is left out; nothing is guessed.
///
/// A stage is bound by its roof from half of it on. Below, it is bound by memory if it moves
/// between 60 % and 110 % of what memory delivers; else by neither.
std::vector<ProfileFinding> profile_findings(const Profile& profile);

}  // namespace vantage
