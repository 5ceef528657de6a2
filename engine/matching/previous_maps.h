#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "engine/image/disparity_maps.h"
#include "engine/image/photograph.h"
#include "engine/image/side.h"
#include "engine/image/tile_mask.h"
#include "engine/matching/map_search.h"
#include "engine/refinement/kept_refinement.h"

namespace vantage {

/// What the maps of a pair keep from those of the pair before (EQUATIONS §3.14). Maps have half the
/// size of the images. Thread rule: one call at a time.
class PreviousMaps {
 public:
  struct OfSide {
    MatchedMap winners;  ///< disparities and confidence, before refinement
    TileMask searched;   ///< tiles to search in the next map
    MapSearchWork search;
    KeptRefinement refinement;
  };

  PreviousMaps() = default;
  PreviousMaps(const PreviousMaps&) = delete;
  PreviousMaps& operator=(const PreviousMaps&) = delete;
  virtual ~PreviousMaps() = default;

  /// Chooses the tiles that the next pair searches. `left`, `right`: 8-bit grey, half the size of
  /// the images. All tiles of a map of which there is none of this size from the pair before.
  void choose(const Photograph& left, const Photograph& right);

  [[nodiscard]] OfSide& of(Side side) { return sides_[index_of(side)]; }
  [[nodiscard]] const OfSide& of(Side side) const { return sides_[index_of(side)]; }
  /// The next pair has no predecessor.
  void forget();
  [[nodiscard]] std::size_t held_bytes() const;

 private:
  /// Sets OfSide::searched. is_first: there are no maps before.
  virtual void choose_tiles(const Image<std::uint8_t>& left, const Image<std::uint8_t>& right,
                            bool is_first) = 0;

  std::array<OfSide, 2> sides_;
};

}  // namespace vantage
