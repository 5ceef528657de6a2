#pragma once

#include <list>
#include <memory>
#include <mutex>

#include "engine/execution.h"
#include "engine/matching/stereo_matcher.h"
#include "engine/sequence/shots.h"

namespace vantage {

/// Options of a run with the range to search in one shot, and their matcher.
struct ShotMatcher {
  ShotMatcher(const MatchOptions& of_shot, Execution& execution)
      : options(of_shot), matcher(of_shot, execution) {}

  MatchOptions options;
  StereoMatcher matcher;
};

/// The matchers of the shots that frames in flight belong to. Thread rule: may be used
/// concurrently.
class ShotMatchers {
 public:
  /// `shots` is null if all frames are searched in the range of `options`. All must outlive this.
  ShotMatchers(const MatchOptions& options, const ShotTable* shots, Execution& execution);

  /// The matcher of a frame; it lives while referenced.
  [[nodiscard]] std::shared_ptr<const ShotMatcher> of(int frame) const;
  /// Memory of the latest one, see StereoMatcher.
  void add_memory_use(MemoryUse& use) const;

 private:
  const MatchOptions& options_;
  const ShotTable* shots_;
  Execution& execution_;
  mutable std::mutex mutex_;
  mutable std::list<std::shared_ptr<const ShotMatcher>> latest_;  ///< the last one used first
};

}  // namespace vantage
