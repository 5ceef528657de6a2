#pragma once

#include <memory>

namespace vantage {

/// A match that StereoMatcher::match() left for later, because the images moved: it needs nothing
/// of the pair before, and the next pair nothing of it. So pairs that moved can be matched at the
/// same time, although they are looked at in order.
struct DeferredMatch {
  bool is_pending = false;
  /// What the matcher prepared of the images. Must not outlive the matcher.
  std::shared_ptr<void> prepared = nullptr;
};

}  // namespace vantage
