#pragma once

#include <cstring>

#include "engine/image/image.h"
#include "engine/matching/stereo_matcher.h"

namespace vantage::test {

/// Whether both hold the same bits, unknown pixels included.
template <typename T>
bool identical(const Image<T>& a, const Image<T>& b) {
  if (a.width() != b.width() || a.height() != b.height()) {
    return false;
  }
  for (int y = 0; y < a.height(); ++y) {
    if (std::memcmp(a.row(y), b.row(y), sizeof(T) * static_cast<std::size_t>(a.width())) != 0) {
      return false;
    }
  }
  return true;
}

/// The same of the maps of both images and their confidences.
inline bool identical(const DisparityMaps& a, const DisparityMaps& b) {
  return identical(a.left.disparity_px, b.left.disparity_px) &&
         identical(a.right.disparity_px, b.right.disparity_px) &&
         identical(a.left.confidence, b.left.confidence) &&
         identical(a.right.confidence, b.right.confidence);
}

}  // namespace vantage::test
