#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "engine/matching/pair_exposure.h"
#include "engine/matching/previous_maps.h"
#include "engine/matching/reduced_matcher.h"
#include "engine/matching/search/coarse_to_fine/coarse_levels.h"
#include "engine/matching/stereo_matcher.h"
#include "engine/matching/windows/reduced_images.h"
#include "engine/object_pool.h"
#include "engine/refinement/refine_maps.h"

// What the files of StereoMatcher share; its users need none of it.

namespace vantage {

/// Inputs prepared for matching, and its working memory.
struct StereoMatcher::Prepared {
  PreparedPair pair;
  std::vector<CostImage> images;
  MethodParameters parameters;  ///< in force, plus the values estimated from the images
  IntensityChanges of_right;
  EdgeWeightLevels edges;  ///< of the map being computed
  CoarseLevels levels;
  /// Coarse maps of the left and the right image for the cross-check.
  std::array<Image<std::int32_t>, 2> coarse_winners;
  /// Check maps beside whole maps.
  std::array<DisparityMap, 2> check_px;
  /// Several images: those of the nearest image of either side, to check the reference's.
  std::array<MatchedMap, 2> partner_maps;
  /// Symmetric selection: energies of the right image.
  LevelVolume right_energies;
  std::array<ReducedImages, 2> halves;  ///< of both images, to find what changed
};

/// What is computed of an image's map: the map, and what is used to check the other one.
struct StereoMatcher::MapNeed {
  bool whole = false;   ///< the map, unless check_is_only
  bool coarse = false;  ///< a coarse level
  bool check = false;   ///< a check map
  bool check_is_only = false;
  [[nodiscard]] bool any() const { return whole || coarse; }
};

/// One image and the map to compute for it.
struct StereoMatcher::MapTask {
  Side side;
  const Photograph* image;
  MatchedMap* map;
  MapNeed need = {};
  ChainInput input = {};
  CoarseWinners coarse = {};             ///< empty: not needed
  ImageView<const float> check_px = {};  ///< empty: not needed
  PreviousMaps* previous = nullptr;      ///< of both maps; null: everything is searched
};

/// One of several images on a line.
struct PlacedImage {
  const Photograph* photograph;
  double place = 0;  ///< 0: the reference; in the distance of the first other image, of its sign
  IntensityChanges changes = {};  ///< to the reference's grey levels
};

struct StereoMatcher::Parts {
  Parts(const ResolvedMatchOptions& options, Execution& execution) : reduced(options, execution) {}

  std::unique_ptr<PairExposureEstimator> exposure;  ///< null: nothing is estimated
  ReducedMatcher reduced;  ///< for pairs that are searched in reduced images
  ObjectPool<Prepared> prepared;
  ObjectPool<RefinementWork> refinement_works;
};

}  // namespace vantage
