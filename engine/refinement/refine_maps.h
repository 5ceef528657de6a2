#pragma once

#include <array>
#include <functional>
#include <span>
#include <string_view>

#include "engine/execution.h"
#include "engine/image/disparity_maps.h"
#include "engine/image/disparity_range.h"
#include "engine/image/image.h"
#include "engine/image/photograph.h"
#include "engine/refinement/canonical_fill.h"
#include "engine/refinement/edge_snapping.h"
#include "engine/refinement/filled_medians.h"
#include "engine/refinement/kept_refinement.h"
#include "engine/refinement/other_camera_view.h"
#include "engine/refinement/refinement.h"
#include "engine/refinement/refinement_options.h"
#include "engine/refinement/speckles.h"
#include "engine/refinement/surface_fill.h"
#include "engine/refinement/surface_fit.h"
#include "engine/refinement/uniform_pixels.h"

namespace vantage {

/// Wider than any search; too wide for a surface fit.
inline constexpr DisparityRange kAnyDisparity{-(1 << 20), 1 << 20};

/// Map of one of several other images.
struct PartnerMap {
  ImageView<const float> disparity_px;  ///< in the unit of the map to check, NaN = unknown
  /// Distance of its camera, in that of the cameras whose disparities these are; negative: on the
  /// other side.
  double baseline_ratio = 1;
};

/// One map to refine; all images have one size.
struct MapToRefine {
  Side side = Side::kLeft;
  /// The map's own; for edge snapping, medians, and what is left out of it.
  const Photograph* image = nullptr;
  /// In: winners, NaN = unknown; out: the refined map. Without disparities there is no map to
  /// refine, only the other one to check. `disparity_y_px`: of a two-dimensional search, else
  /// empty. `confidence`: read if uses_confidence(). `unmatched` is output only.
  MatchedMap* map = nullptr;
  /// Checks the other map in place of this one, image-sized. Empty: the map itself.
  ImageView<const float> check_px = {};
  /// Of several other images, in place of the other map: a pixel is matched if one of them agrees.
  std::span<const PartnerMap> partners = {};
  /// false: the map is only needed to cross-check the other; it and its `unmatched` are then
  /// undefined.
  bool is_result = true;
  /// Search range of the disparities (and of disparity_y_px); refined values stay within it.
  DisparityRange search = kAnyDisparity;
  DisparityRange search_y = kAnyDisparity;
  /// Columns and rows of a map of half the size are 2 pixels apart; its disparities are in pixels.
  int pixels_per_column = 1;
  /// Where nothing changed since the pair before, its refined values stay. Null: all are refined.
  KeptRefinement* kept = nullptr;
};

/// Working memory of refine_maps(), reused from call to call.
struct RefinementWork {
  EdgeSnappingWork edge_snapping;
  std::array<SpeckleWork, 2> speckles;
  SurfaceFitWork surface_fit;
  FilledMediansWork filled_medians;
  UniformPixelsWork uniform_pixels;
  SurfaceFillWork surface_fill;
  Mask uniform;                                ///< pixels of regions without texture
  Mask rest;                                   ///< unmatched pixels that are not
  Mask of_partner;                             ///< of one of several maps
  std::array<OtherCameraView, 2> other_views;  ///< of the left and of the right map
};

std::size_t held_bytes(const RefinementWork& work);

/// Refines winners to dense maps (EQUATIONS §5): edge snapping → cross-check → confidence →
/// speckles → surface fit → fill, as set in `options`. `other`: the map of the other image, also
/// refined if it is a result; null: no cross-check but with `map.partners`; without one unknown
/// pixels are unmatched instead. Pixels that are left out of the images are unmatched, and so are
/// their partners.
/// `start_step` is called with the name of each step before it runs (static storage). Identical for
/// any `execution`.
void refine_maps(const RefinementOptions& options, const MapToRefine& map, const MapToRefine* other,
                 Execution& execution, RefinementWork& work,
                 const std::function<void(std::string_view)>& start_step);

}  // namespace vantage
