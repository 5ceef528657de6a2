#include "engine/sequence/shots/shot_matchers.h"

#include <algorithm>

namespace vantage {
namespace {

/// Frames in flight rarely belong to more shots.
constexpr std::size_t kKept = 2;

}  // namespace

ShotMatchers::ShotMatchers(const MatchOptions& options, const ShotTable* shots,
                           const Rectifier* rectifier, Execution& execution)
    : options_(options),
      shots_(shots),
      grids_(rectifier != nullptr ? epipolar_grids(*rectifier, execution) : nullptr),
      execution_(execution) {
  latest_.push_back(std::make_shared<const ShotMatcher>(options_, grids_, execution_));
}

std::shared_ptr<const ShotMatcher> ShotMatchers::of(
    int frame, const std::optional<DisparityRange>& of_pair) const {
  DisparityRange range = options_.disparities;
  if (shots_ != nullptr) {
    range = shots_->shot_of(frame).search.value_or(range);
  }
  range = of_pair.value_or(range);
  const std::scoped_lock lock(mutex_);
  const auto known = std::ranges::find_if(
      latest_, [&](const auto& one) { return one->options.disparities == range; });
  if (known != latest_.end()) {
    latest_.splice(latest_.begin(), latest_, known);
    return latest_.front();
  }
  MatchOptions options = options_;
  options.disparities = range;
  latest_.push_front(std::make_shared<const ShotMatcher>(options, grids_, execution_));
  if (latest_.size() > kKept) {
    latest_.pop_back();
  }
  return latest_.front();
}

void ShotMatchers::add_memory_use(MemoryUse& use) const {
  const std::scoped_lock lock(mutex_);
  latest_.front()->matcher.add_memory_use(use);
}

}  // namespace vantage
