#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "engine/execution.h"
#include "engine/image/disparity_maps.h"
#include "engine/image/photograph.h"
#include "engine/image/side.h"
#include "engine/image/tile_mask.h"
#include "engine/matching/options/match_options.h"
#include "engine/matching/search/coarse_to_fine/coarse_levels.h"
#include "engine/refinement/kept_refinement.h"

namespace vantage {

/// Why maps of these options cannot keep anything from the pair before, in words; empty: they can.
std::string_view reuse_obstacle(const ResolvedMatchOptions& options);

/// Copies disparities and confidence.
void copy_winners(const MatchedMap& map, Execution& execution, MatchedMap& copy);

/// What the maps of a pair keep from those of the pair before (EQUATIONS §3.14). Maps have the size
/// of the images, or half of it with a reduced search-size. Thread rule: one call at a time.
class PreviousMaps {
 public:
  struct OfSide {
    MatchedMap winners;  ///< disparities and confidence, before refinement
    TileMask searched;   ///< tiles to search in the next map, of the map's size
    CoarseLevels levels{true};
    KeptRefinement refinement;
    DisparityMap check_px;  ///< check map beside a whole map
  };
  /// What is computed of both maps. Pairs of different contents have nothing in common.
  struct Content {
    scheduler::Extent map;   ///< size of the maps
    std::uint32_t maps = 0;  ///< any number for the kind of maps
    friend bool operator==(const Content&, const Content&) = default;
  };

  PreviousMaps() = default;
  PreviousMaps(const PreviousMaps&) = delete;
  PreviousMaps& operator=(const PreviousMaps&) = delete;
  virtual ~PreviousMaps() = default;

  /// Chooses the tiles that the next pair searches. `left`, `right`: 8-bit grey, half the size of
  /// the images. All tiles if the pair before had another content, or kept nothing, or there is
  /// none. False: the images moved, and this pair is searched as if alone and keeps nothing, which
  /// costs less.
  [[nodiscard]] bool choose(const Photograph& left, const Photograph& right,
                            const Content& content);

  [[nodiscard]] OfSide& of(Side side) { return sides_[index_of(side)]; }
  [[nodiscard]] const OfSide& of(Side side) const { return sides_[index_of(side)]; }
  /// The tiles to search of this map; null: all.
  [[nodiscard]] const TileMask* searched_tiles(Side side) const {
    const TileMask& searched = of(side).searched;
    return searched.count() < searched.size() ? &searched : nullptr;
  }
  /// The next pair has no predecessor.
  void forget();
  [[nodiscard]] std::size_t held_bytes() const;

 private:
  /// Sets the tiles to search, of images of half the size; false: the images moved. is_first: there
  /// are no images before.
  virtual bool choose_tiles(const Image<std::uint8_t>& left, const Image<std::uint8_t>& right,
                            bool is_first, std::array<TileMask, 2>& searched) = 0;

  void forget_maps();

  std::array<OfSide, 2> sides_;
  std::optional<Content> content_;  ///< of the pair before
  bool has_maps_ = false;           ///< of the pair before
  std::array<TileMask, 2> half_size_;
};

}  // namespace vantage
