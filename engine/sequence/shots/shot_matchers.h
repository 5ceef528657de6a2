#pragma once

#include <list>
#include <memory>
#include <mutex>
#include <optional>

#include "engine/execution.h"
#include "engine/matching/stereo_matcher.h"
#include "engine/matching/unrectified_matcher.h"
#include "engine/sequence/shots/shots.h"

namespace vantage {

/// Options of a run with the range to search in one shot, and their matcher.
struct ShotMatcher {
  /// `grids`: of photographs that are not rectified; null: rows are searched.
  ShotMatcher(const MatchOptions& of_shot, const std::shared_ptr<const EpipolarGrids>& grids,
              Execution& execution)
      : options(of_shot), matcher(of_shot, execution) {
    if (grids != nullptr) {
      unrectified.emplace(of_shot, grids, execution);
    }
  }

  MatchOptions options;
  StereoMatcher matcher;
  std::optional<UnrectifiedMatcher> unrectified;
};

/// The matchers of the shots that frames in flight belong to. Thread rule: may be used
/// concurrently.
class ShotMatchers {
 public:
  /// `shots` is null if all frames are searched in the range of `options`; `rectifier` if pairs are
  /// rectified. All must outlive this.
  ShotMatchers(const MatchOptions& options, const ShotTable* shots, const Rectifier* rectifier,
               Execution& execution);

  /// The matcher of a frame, for the range of its pair if that has one; it lives as long as
  /// somebody holds it.
  [[nodiscard]] std::shared_ptr<const ShotMatcher> of(
      int frame, const std::optional<DisparityRange>& of_pair) const;
  /// Memory of the latest one, see StereoMatcher.
  void add_memory_use(MemoryUse& use) const;

 private:
  const MatchOptions& options_;
  const ShotTable* shots_;
  std::shared_ptr<const EpipolarGrids> grids_;  ///< null: rows are searched
  Execution& execution_;
  mutable std::mutex mutex_;
  mutable std::list<std::shared_ptr<const ShotMatcher>> latest_;  ///< the last one used first
};

}  // namespace vantage
