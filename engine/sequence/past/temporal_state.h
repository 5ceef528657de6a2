#pragma once

#include <cstdint>

#include "engine/execution.h"
#include "engine/image/photograph.h"
#include "engine/matching/stereo_matcher.h"
#include "engine/sequence/past/still_pixels.h"
#include "engine/sequence/past/temporal_options.h"

namespace vantage {

/// State that matching a frame takes from the previous frame in its chunk: for each map the
/// disparities of pixels whose own image did not change and that were matched, not filled.
///
/// Use: restart() at the first frame of a chunk; for each frame priors_for(), match, remember().
/// Thread rule: one call at a time; results are identical for any Execution. Memory is reused:
/// frames of one size allocate nothing after the second one.
class TemporalState {
 public:
  /// Throws UsageError for invalid options.
  explicit TemporalState(const TemporalOptions& options);

  /// The next frame has no predecessor.
  void restart();

  /// MatchRequest::prior for StereoMatcher::match() of this pair; valid until the next call of this
  /// or remember(). Empty with weight 0, for the first frame, if the size of the images changes,
  /// and after a cut, i.e. for a map of whose image less than 1/50 is still.
  DisparityPrior priors_for(const Photograph& left, const Photograph& right, Execution& execution);

  /// Stores the maps of this pair, with their masks of unmatched pixels; an empty map is stored as
  /// none. Call it once per frame, after priors_for().
  void remember(const Photograph& left, const Photograph& right, const DisparityMaps& maps,
                Execution& execution);

 private:
  struct Side {
    Image<std::uint8_t> intensities;  ///< of the previous frame
    DisparityMap matched_px;          ///< of the previous frame, NaN where filled; empty: none
    DisparityMap prior_px;
    Image<std::uint8_t> next_intensity;
    bool intensity_is_next = false;  ///< next_intensity are those of the current frame
    Mask still;
  };
  ImageView<const float> prior_for(const Photograph& image, Side& side, Execution& execution);
  void remember_side(const Photograph& image, const DisparityMap& map, const Mask& unmatched,
                     Side& side, Execution& execution);

  TemporalOptions options_;
  StillPixels still_pixels_;
  Side left_;
  Side right_;
};

}  // namespace vantage
