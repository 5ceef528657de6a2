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
  return identical(a.left, b.left) && identical(a.right, b.right) &&
         identical(a.left_confidence, b.left_confidence) &&
         identical(a.right_confidence, b.right_confidence);
}

}  // namespace vantage::test
