#include "engine/matching/previous_maps.h"

#include <cstdint>
#include <variant>

#include "engine/image/memory_use.h"

namespace vantage {

void PreviousMaps::choose(const Photograph& left, const Photograph& right) {
  const auto has_map = [&](const OfSide& side) {
    const DisparityMap& map_px = side.winners.disparity_px;
    return map_px.width() == left.width() && map_px.height() == left.height();
  };
  choose_tiles(std::get<Image<std::uint8_t>>(left.pixels),
               std::get<Image<std::uint8_t>>(right.pixels),
               !has_map(sides_[0]) && !has_map(sides_[1]));
  for (OfSide& side : sides_) {
    if (!has_map(side)) {  // perhaps only the other map was requested before
      side.searched.assign(left.width(), left.height(), true);
      side.refinement.restart();
    }
    side.refinement.start(side.searched);
  }
}

void PreviousMaps::forget() {
  for (OfSide& side : sides_) {
    side.winners.disparity_px.resize(0, 0);
    side.refinement.restart();
  }
}

std::size_t PreviousMaps::held_bytes() const {
  std::size_t bytes = 0;
  for (const OfSide& side : sides_) {
    bytes += vantage::held_bytes(side.winners) + side.refinement.held_bytes() +
             side.search.levels.held_bytes();
  }
  return bytes;
}

}  // namespace vantage
