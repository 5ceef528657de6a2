#pragma once

#include "engine/image/image.h"

namespace vantage {

/// Keeps for each pixel the better of the winners found so far and those of one more vertical
/// disparity; the earlier of equals.
struct WinnerMerge {
  ImageView<const float> candidate_disparity_px;
  ImageView<const float> candidate_confidence = {};  ///< empty: not wanted
  ImageView<const float> candidate_energy;
  int disparity_y_px = 0;
  ImageView<float> disparity_px;
  ImageView<float> disparity_y;
  ImageView<float> confidence = {};
  ImageView<float> energy;

  void merge_row(int y) const {
    for (int x = 0; x < energy.width(); ++x) {
      // NaN where the row has no candidate: not less than anything.
      if (!(candidate_energy.at(x, y) < energy.at(x, y))) {
        continue;
      }
      energy.at(x, y) = candidate_energy.at(x, y);
      disparity_px.at(x, y) = candidate_disparity_px.at(x, y);
      disparity_y.at(x, y) = static_cast<float>(disparity_y_px);
      if (!confidence.empty()) {
        confidence.at(x, y) = candidate_confidence.at(x, y);
      }
    }
  }
};

}  // namespace vantage
