#include "engine/refinement/refine_maps.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "engine/image/left_out.h"
#include "engine/refinement/border_planes.h"
#include "kernels/filled_median/filled_median.h"

namespace vantage {
namespace {

OtherCameraView& other_view(const MapToRefine& map, RefinementWork& work) {
  return work.other_views[map.side == Side::kLeft ? 0 : 1];
}

void copy_map(const DisparityMap& map_px, Execution& execution, DisparityMap& copy_px) {
  copy_px.resize(map_px.width(), map_px.height());
  execution.for_each_row(
      map_px.height(), [&](int y) { std::copy_n(map_px.row(y), map_px.width(), copy_px.row(y)); });
}

void check_against(const RefinementOptions& options, const MapToRefine& to_refine,
                   const MapToRefine& other, Execution& execution, RefinementWork& work) {
  MatchedMap& map = *to_refine.map;
  const MatchedMap& partner = *other.map;
  const ImageView<const float> map_px = std::as_const(map.disparity_px).view();
  if (!map.disparity_y_px.empty()) {
    cross_check({map_px, map.disparity_y_px.view()},
                {partner.disparity_px.view(), partner.disparity_y_px.view()}, to_refine.side,
                options.cross_check_px, execution, map.unmatched);
    return;
  }
  const ImageView<const float> check_px =
      other.check_px.empty() ? partner.disparity_px.view() : other.check_px;
  const float columns_per_px = 1.0F / static_cast<float>(to_refine.pixels_per_column);
  cross_check(map_px, check_px, to_refine.side, options.cross_check_px, execution, map.unmatched,
              columns_per_px);
  if (options.fill == Fill::kSurfaces) {
    OtherCameraView& view = other_view(to_refine, work);
    view.side = to_refine.side;
    view.columns_per_px = columns_per_px;
    view.map_px = check_px;
    if (other.check_px.empty() && other.is_result) {
      copy_map(partner.disparity_px, execution, view.copy_px);
      view.map_px = std::as_const(view.copy_px).view();
    }
    keep_matched(map_px, options.cross_check_px, execution, work.of_partner, view);
  }
}

void check_against_partners(const MapToRefine& to_refine, double tolerance_px, Execution& execution,
                            RefinementWork& work) {
  MatchedMap& map = *to_refine.map;
  for (const PartnerMap& partner : to_refine.partners) {
    const bool is_first = &partner == to_refine.partners.data();
    Mask& unmatched = is_first ? map.unmatched : work.of_partner;
    cross_check(map.disparity_px.view(), partner.disparity_px,
                partner.baseline_ratio > 0 ? to_refine.side : other_side(to_refine.side),
                tolerance_px, execution, unmatched,
                static_cast<float>(std::abs(partner.baseline_ratio)));
    if (is_first) {
      continue;
    }
    execution.for_each_row(unmatched.height(), [&](int y) {
      std::uint8_t* const of_all = map.unmatched.row(y);
      std::transform(of_all, of_all + unmatched.width(), unmatched.row(y), of_all,
                     [](std::uint8_t a, std::uint8_t b) { return std::min(a, b); });
    });
  }
}

const Mask& left_out_of(const MapToRefine* map) {
  static const Mask none;
  return map != nullptr && map->image != nullptr ? map->image->left_out : none;
}

/// Samples of medians, in columns of the map. Values that surfaces gave need smoothing only: the
/// samples are nearer.
kernels::FilledMedianGrid median_grid(const MapToRefine& map, bool is_filled_by_surfaces) {
  if (map.pixels_per_column != 1) {
    return {.count = 5, .step_px = 2};
  }
  return {.step_px = is_filled_by_surfaces ? 2 : kernels::kFilledMedianStepPx};
}

SurfaceEnergy surface_energy(Fill fill) {
  return fill == Fill::kThinPlate ? SurfaceEnergy::kThinPlate : SurfaceEnergy::kMembrane;
}

bool takes_medians(Fill fill) {
  return fill != Fill::kConstant && fill != Fill::kLinear && fill != Fill::kNone;
}

/// Half the columns tell too little of slopes to take planes by default.
bool takes_planes(Fill fill, int pixels_per_column) {
  return fill == Fill::kPlanes || (fill == Fill::kSurfaces && pixels_per_column == 1);
}

using MapsToRefine = std::span<const MapToRefine* const>;

void snap_edges(const RefinementOptions& options, MapsToRefine maps, Execution& execution,
                RefinementWork& work) {
  for (const MapToRefine* one : maps) {
    if (one->map->disparity_px.empty()) {
      continue;
    }
    find_edges(*one->image, execution, work.edge_snapping);
    snap_discontinuities(work.edge_snapping.edges, options.edge_snapping_px, execution,
                         one->map->disparity_px);
  }
}

void fit_surfaces(const RefinementOptions& options, MapsToRefine maps, Execution& execution,
                  RefinementWork& work) {
  for (const MapToRefine* one : maps) {
    MatchedMap& matched = *one->map;
    fit_surface(matched.unmatched, options.surface_fit_px, options.surface_fit_step_px, one->search,
                execution, work.surface_fit, matched.disparity_px,
                one->kept != nullptr ? &one->kept->changed() : nullptr);
    if (!matched.disparity_y_px.empty()) {
      fit_surface(matched.unmatched, options.surface_fit_px, options.surface_fit_step_px,
                  one->search_y, execution, work.surface_fit, matched.disparity_y_px);
    }
  }
}

/// Makes one map dense. is_checked: against the other one.
void fill(const RefinementOptions& options, const MapToRefine& map, bool is_checked,
          Execution& execution, RefinementWork& work) {
  const bool is_canonical = fills_uniform_regions(options.fill);
  MatchedMap& matched = *map.map;
  if (map.kept != nullptr) {
    map.kept->restore(matched.disparity_px);
  }
  if (is_canonical) {
    find_textureless_pixels(*map.image, options.uniform_contrast, execution, work.uniform_pixels,
                            work.uniform);
    keep_visible_unmatched(matched.disparity_px.view(), matched.unmatched, map.side,
                           map.pixels_per_column, execution, work.uniform);
  }
  const bool is_in_rows = matched.disparity_y_px.empty();
  const bool takes_surfaces = is_checked && is_in_rows && options.fill == Fill::kSurfaces;
  if (takes_medians(options.fill)) {
    frame_photograph(*map.image, execution, work.filled_medians);
  }
  for (DisparityMap* component_px : {&matched.disparity_px, &matched.disparity_y_px}) {
    if (component_px->empty()) {
      continue;
    }
    const Mask* unmatched = &matched.unmatched;
    if (is_canonical) {
      work.rest = matched.unmatched.copy();
      fill_canonically(work.uniform, work.uniform_pixels.grey, surface_energy(options.fill),
                       component_px == &matched.disparity_px ? map.search : map.search_y, execution,
                       work.rest, *component_px);
      unmatched = &work.rest;
    }
    fill_unmatched(*unmatched, map.side, options.fill, execution, *component_px);
    if (is_in_rows && takes_planes(options.fill, map.pixels_per_column)) {
      fill_border_planes(*unmatched, map.side, map.pixels_per_column, map.search, execution,
                         *component_px);
    }
    if (takes_surfaces) {
      fill_by_surfaces(*unmatched, other_view(map, work), work.filled_medians, map.search,
                       execution, work.surface_fill, *component_px);
    }
    if (takes_medians(options.fill)) {
      take_filled_medians(*unmatched, median_grid(map, takes_surfaces), execution,
                          work.filled_medians, *component_px,
                          map.kept != nullptr && !is_canonical ? &map.kept->changed() : nullptr);
    }
  }
  if (map.kept != nullptr) {
    if (!is_canonical) {  // whose regions reach over many tiles
      map.kept->restore(matched.disparity_px);
    }
    map.kept->remember(matched);
  }
}

}  // namespace

std::size_t held_bytes(const RefinementWork& work) {
  return held_bytes(work.edge_snapping) + held_bytes(work.speckles[0]) +
         held_bytes(work.speckles[1]) + held_bytes(work.surface_fit) +
         held_bytes(work.filled_medians) + held_bytes(work.uniform_pixels) +
         held_bytes(work.uniform) + held_bytes(work.surface_fill) + held_bytes(work.rest) +
         held_bytes(work.of_partner) + held_bytes(work.other_views[0]) +
         held_bytes(work.other_views[1]);
}

void refine_maps(const RefinementOptions& options, const MapToRefine& map, const MapToRefine* other,
                 Execution& execution, RefinementWork& work,
                 const std::function<void(std::string_view)>& start_step) {
  const std::array<const MapToRefine*, 2> both = {&map, other};
  MapsToRefine maps(both.data(), other != nullptr ? 2 : 1);

  if (options.edge_snapping_px > 0) {
    start_step("edge snapping");
    snap_edges(options, maps, execution, work);
  }
  // Both are checked before either is changed.
  const bool has_partners = !map.partners.empty();
  const bool is_checked = options.cross_check && (other != nullptr || has_partners);
  if (is_checked) {
    start_step("cross-check");
    if (has_partners) {
      check_against_partners(map, options.cross_check_px, execution, work);
    } else if (map.is_result) {
      check_against(options, map, *other, execution, work);
    }
    if (other != nullptr && other->is_result) {
      check_against(options, *other, map, execution, work);
    }
  }
  if (other != nullptr && !(map.is_result && other->is_result)) {
    maps = maps.subspan(map.is_result ? 0 : 1, map.is_result || other->is_result ? 1 : 0);
  }
  if (!is_checked) {
    for (const MapToRefine* one : maps) {
      mark_unknown(one->map->disparity_px.view(), execution, one->map->unmatched);
    }
  }
  for (const MapToRefine* one : maps) {
    mark_left_out(left_out_of(one), left_out_of(one == &map ? other : &map), one->side,
                  1.0F / static_cast<float>(one->pixels_per_column), execution, *one->map);
  }
  if (uses_confidence(options)) {
    start_step("confidence");
    for (const MapToRefine* one : maps) {
      mark_unsure(one->map->confidence.view(), options.confidence_threshold, execution,
                  one->map->unmatched);
    }
  }
  if (options.speckle_size_px > 1) {
    start_step("speckles");
    execution.executor().parallel_for(static_cast<int>(maps.size()), [&](int index) {
      MatchedMap& matched = *maps[static_cast<std::size_t>(index)]->map;
      mark_speckles(matched.disparity_px.view(), matched.disparity_y_px.view(),
                    options.speckle_size_px, work.speckles[static_cast<std::size_t>(index)],
                    matched.unmatched);
    });
  }
  for (const MapToRefine* one : maps) {
    if (one->kept != nullptr) {
      one->kept->find_changed(one->map->unmatched);
    }
  }
  if (options.surface_fit_px > 0) {
    start_step("surface fit");
    fit_surfaces(options, maps, execution, work);
  }
  start_step("fill");
  for (const MapToRefine* one : maps) {
    fill(options, *one, is_checked && !has_partners, execution, work);
  }
}

}  // namespace vantage
