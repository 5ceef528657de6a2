#pragma once

#include <array>
#include <functional>
#include <string_view>

#include "engine/execution.h"
#include "engine/image/disparity_maps.h"
#include "engine/image/disparity_range.h"
#include "engine/image/image.h"
#include "engine/image/photograph.h"
#include "engine/refinement/edge_snapping.h"
#include "engine/refinement/filled_medians.h"
#include "engine/refinement/refinement.h"
#include "engine/refinement/refinement_options.h"
#include "engine/refinement/speckles.h"
#include "engine/refinement/surface_fit.h"

namespace vantage {

/// Wider than any search.
inline constexpr DisparityRange kAnyDisparity{-(1 << 20), 1 << 20};

/// One map on its way through refinement; all images have one size.
struct MapToRefine {
  Side side = Side::kLeft;
  const Photograph* image = nullptr;  ///< the map's own; for edge snapping and medians
  /// Winners, NaN = unknown, become the refined map. Without disparities there is none to be made,
  /// only the other map to be checked. `disparity_y_px`: of a two-dimensional search, else empty.
  /// `confidence`: read where uses_confidence(). `unmatched` is a result.
  MatchedMap* map = nullptr;
  /// What the other map is checked against in place of this one, of the same size; empty: this one.
  ImageView<const float> check_px = {};
  /// false: the map is there for the cross-check of the other one alone; what becomes of it, and
  /// its `unmatched`, mean nothing.
  bool is_result = true;
  /// What the disparities, and those of disparity_y_px, were searched in, and stay within.
  DisparityRange search = kAnyDisparity;
  DisparityRange search_y = kAnyDisparity;
};

/// Working memory of refine_maps(), reused from call to call.
struct RefinementWork {
  EdgeSnappingWork edge_snapping;
  std::array<SpeckleWork, 2> speckles;
  SurfaceFitWork surface_fit;
  FilledMediansWork filled_medians;
};

std::size_t held_bytes(const RefinementWork& work);

/// Makes dense maps of winners (EQUATIONS §5): edge snapping → cross-check → confidence → speckles
/// → surface fit → fill, each as `options` says. `other`: the map of the other image, refined as
/// well if it is a result; null: there is none, and no cross-check, the unknown pixels are
/// unmatched instead. `begin_step` is told the name of each step that is taken ahead of it (static
/// storage). Identical for any `execution`.
void refine_maps(const RefinementOptions& options, const MapToRefine& map, const MapToRefine* other,
                 Execution& execution, RefinementWork& work,
                 const std::function<void(std::string_view)>& begin_step);

}  // namespace vantage
