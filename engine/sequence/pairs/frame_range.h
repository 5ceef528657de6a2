#pragma once

#include <algorithm>

namespace vantage {

/// Frames [first, end) of a run, numbered from 0 over the whole input.
struct FrameRange {
  int first = 0;
  int end = 0;

  [[nodiscard]] int count() const { return std::max(0, end - first); }
  [[nodiscard]] bool empty() const { return end <= first; }
  [[nodiscard]] bool contains(int frame) const { return first <= frame && frame < end; }
  [[nodiscard]] bool contains(FrameRange other) const {
    return first <= other.first && other.end <= end;
  }
  [[nodiscard]] FrameRange intersection(FrameRange other) const {
    return {std::max(first, other.first), std::min(end, other.end)};
  }
  friend bool operator==(const FrameRange&, const FrameRange&) = default;
};

}  // namespace vantage
