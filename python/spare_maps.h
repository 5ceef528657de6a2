#pragma once

#include <cstddef>
#include <mutex>
#include <utility>
#include <vector>

#include "engine/image/disparity_maps.h"

namespace vantage::python {

/// Memory of results that are gone, for the maps of the next ones: new pages would take a twentieth
/// of the time of a small pair. Thread rule: any thread.
class SpareMaps {
 public:
  /// Maps with any contents; without memory if there are none to spare.
  DisparityMaps take() {
    const std::lock_guard lock(mutex_);
    if (maps_.empty()) {
      return {};
    }
    DisparityMaps maps = std::move(maps_.back());
    maps_.pop_back();
    return maps;
  }
  void give(DisparityMaps maps) {
    const std::lock_guard lock(mutex_);
    if (maps_.size() < kMaxSpare) {
      maps_.push_back(std::move(maps));
    }
  }

 private:
  /// The result before, and one that is being replaced.
  static constexpr std::size_t kMaxSpare = 2;
  std::mutex mutex_;
  std::vector<DisparityMaps> maps_;
};

}  // namespace vantage::python
