#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "engine/image/disparity_maps.h"
#include "engine/image/image_region.h"
#include "engine/image/photograph.h"
#include "engine/matching/options/match_options.h"
#include "scheduler/range.h"

namespace vantage {

/// The options with which a part of images is matched, at its size: the range in reduced pixels.
/// Other lengths in pixels count reduced pixels as they are.
ResolvedMatchOptions options_of_part(MatchOptions options);

/// What MatchOptions::roi and MatchOptions::scale leave of the images of a call: all are cut to the
/// same rows and columns, those of the region with all that pixels of the region may be compared
/// with and some context around, then reduced. Maps are brought back to the pixels of the images.
/// Thread rule: immutable.
class MatchedPart {
 public:
  /// `images`: their size. `places`: of the images, in the distance of the first other one from the
  /// reference, positive where it is on the other side than the reference's name says; 0, 1 of a
  /// pair. Throws Error where the region is not inside the images.
  MatchedPart(const ResolvedMatchOptions& options, scheduler::Extent images,
              std::span<const double> places, Side reference = Side::kLeft);

  /// The size of what is matched.
  [[nodiscard]] scheduler::Extent extent() const { return extent_; }
  /// What is matched of an image, which must outlive it.
  [[nodiscard]] Photograph of(const Photograph& photograph) const;
  /// The same of a prior. Empty: none.
  [[nodiscard]] DisparityMap of_prior(ImageView<const float> map_px) const;

  /// Makes the map of `image`, number `index` of the call, of that of its part: disparities in its
  /// own pixels, linear within surfaces. Unknown, and unmatched, outside the region.
  void bring_back(const MatchedMap& map_of_part, std::size_t index, const Photograph& image,
                  MatchedMap& map) const;

 private:
  DisparityRange range_;
  DisparityRange range_y_;
  scheduler::Extent images_;
  scheduler::Region cut_;
  scheduler::Extent extent_;
  std::vector<scheduler::Region> wanted_;  ///< pixels of each image that get disparities
};

}  // namespace vantage
