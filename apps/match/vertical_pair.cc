#include "apps/match/vertical_pair.h"

#include <utility>

#include "engine/image/transposed.h"

namespace vantage::apps {

void transpose(std::vector<Photograph>& images) {
  for (Photograph& image : images) {
    image = transposed(image);
  }
}

void transpose(DisparityMaps& maps) {
  const auto transpose_unless_empty = [](auto& image) {
    if (!image.empty()) {
      image = transposed(std::as_const(image).view());
    }
  };
  for (MatchedMap* map : {&maps.left, &maps.right}) {
    transpose_unless_empty(map->disparity_px);
    transpose_unless_empty(map->disparity_y_px);
    transpose_unless_empty(map->confidence);
    transpose_unless_empty(map->unmatched);
  }
  if (!maps.left.disparity_y_px.empty() || !maps.right.disparity_y_px.empty()) {
    for (MatchedMap* map : {&maps.left, &maps.right}) {
      std::swap(map->disparity_px, map->disparity_y_px);
    }
  }
}

void transpose(CyclopeanMap& map) {
  if (!map.disparity_px.empty()) {
    map.disparity_px = transposed(std::as_const(map.disparity_px).view());
    map.seen_by = transposed(std::as_const(map.seen_by).view());
  }
}

}  // namespace vantage::apps
