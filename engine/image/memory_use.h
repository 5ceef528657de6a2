#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "engine/execution.h"
#include "engine/image/image.h"
#include "engine/image/photograph.h"

namespace vantage {

/// Bytes by purpose. Each figure is the maximum that its owner held, read when its work is done.
/// Owners may reach their maxima at different times, so sums can exceed the peak of the process.
struct MemoryUse {
  struct Owner {
    std::string name;
    std::size_t bytes = 0;
  };
  std::vector<Owner> owners;

  /// Adds to an existing entry of that name; 0 bytes add no entry.
  void add(const std::string& name, std::size_t bytes) {
    if (bytes == 0) {
      return;
    }
    const auto known = std::ranges::find(owners, name, &Owner::name);
    if (known != owners.end()) {
      known->bytes += bytes;
    } else {
      owners.push_back({name, bytes});
    }
  }
};

/// Size of an image's rows. Spare memory left from a larger image is not counted.
template <typename T>
std::size_t held_bytes(const Image<T>& image) {
  return sizeof(T) * image.view().stride() * static_cast<std::size_t>(image.height());
}
inline std::size_t held_bytes(const Photograph& photograph) {
  return std::visit([](const auto& image) { return held_bytes(image); }, photograph.pixels) +
         held_bytes(photograph.left_out);
}
template <typename T>
std::size_t held_bytes(const std::vector<T>& values) {
  return sizeof(T) * values.capacity();
}

/// Scratch memory of strips ("rings"), between passes ("stored iterations") and of other row work
/// ("row work").
inline void add_scratch_use(Execution& execution, MemoryUse& use) {
  using scheduler::ScratchUse;
  const scheduler::ScratchPool& scratch = execution.scratch();
  use.add("rings", scratch.max_leased_bytes(ScratchUse::kRings));
  use.add("stored iterations", scratch.max_leased_bytes(ScratchUse::kStored));
  use.add("row work", scratch.max_leased_bytes(ScratchUse::kOther));
}

}  // namespace vantage
