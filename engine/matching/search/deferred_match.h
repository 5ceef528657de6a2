#pragma once

#include <array>
#include <memory>

#include "engine/matching/windows/reduced_images.h"

namespace vantage {

/// A match that StereoMatcher::match() left for later, because the images moved: it needs nothing
/// of the pair before, and the next pair nothing of it. So pairs that moved can be matched at the
/// same time, although they are looked at in order.
struct DeferredMatch {
  using Images = std::array<ReducedImages, 2>;

  bool is_pending = false;
  /// What is prepared of the images with a reduced search-size. Must not outlive the matcher.
  std::shared_ptr<Images> images = nullptr;
};

}  // namespace vantage
