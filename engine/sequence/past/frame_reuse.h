#pragma once

#include <array>
#include <cstdint>

#include "engine/execution.h"
#include "engine/image/image.h"
#include "engine/matching/search/previous_maps.h"
#include "engine/sequence/past/still_pixels.h"

namespace vantage {

/// Chooses the tiles of a frame that are searched: those where an image changed since they were
/// last searched, and in each frame a share of the others, so that nothing stays wrong for long.
///
/// Use: for each frame start_frame(), then match with MatchRequest::previous. Thread rule: one call
/// at a time; results are identical for any Execution. Memory is reused.
class FrameReuse final : public PreviousMaps {
 public:
  /// threshold: grey levels, 0..255, as TemporalOptions. Throws UsageError if it is out of range.
  FrameReuse(double threshold, Execution& execution)
      : still_pixels_(threshold), execution_(execution) {}

  /// The next frame is this one of its chunk. is_first: there is none before it.
  void start_frame(int frame_of_chunk, bool is_first);

 private:
  bool choose_tiles(const Image<std::uint8_t>& left, const Image<std::uint8_t>& right,
                    bool is_first, std::array<TileMask, 2>& searched) override;
  bool find_changed(Side side, const Image<std::uint8_t>& image, TileMask& changed);
  void add_changed_partners(Side side, TileMask& changed) const;
  [[nodiscard]] bool has_changed(Side side, const scheduler::Region& pixels) const;
  [[nodiscard]] bool have_partners_changed(Side side, const scheduler::Region& pixels) const;

  StillPixels still_pixels_;
  Execution& execution_;
  int frame_of_chunk_ = 0;
  /// Of each tile the image in which it was last searched, half size.
  std::array<Image<std::uint8_t>, 2> searched_in_;
  std::array<Mask, 2> still_;
};

}  // namespace vantage
