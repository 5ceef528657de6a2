#pragma once

#include <cstddef>

#include "engine/image/disparity_maps.h"
#include "engine/image/image.h"
#include "engine/image/tile_mask.h"

namespace vantage {

/// A refined map of one pair after the other, of which tiles keep their values while their winners
/// and the pixels without a match stay as they were (EQUATIONS §3.14). Thread rule: one call at a
/// time.
class KeptRefinement {
 public:
  /// The next map has no predecessor.
  void restart() {
    unmatched_.resize(0, 0);
    refined_px_.resize(0, 0);
  }

  /// The tiles whose winners are new in the next map, of the map's size; all without a predecessor.
  void start(const TileMask& searched) { changed_ = searched; }
  /// Adds the tiles where `unmatched` differs from the map before, and those with pixels without a
  /// match that continue such pixels of a changed tile beside them, because both are filled from
  /// one side.
  void find_changed(const Mask& unmatched);
  /// Tiles to refine.
  [[nodiscard]] const TileMask& changed() const { return changed_; }
  /// Writes the values before into all other tiles.
  void restore(DisparityMap& map_px) const;
  /// Stores the refined map.
  void remember(const MatchedMap& map);

  /// The last refined map; empty: none.
  [[nodiscard]] const DisparityMap& refined_px() const { return refined_px_; }

  [[nodiscard]] std::size_t held_bytes() const {
    return vantage::held_bytes(unmatched_) + vantage::held_bytes(refined_px_);
  }

 private:
  TileMask changed_;
  Mask unmatched_;  ///< of the map before; empty: none
  DisparityMap refined_px_;
};

}  // namespace vantage
