#include "engine/refinement/refine_maps.h"

#include <span>

namespace vantage {
namespace {

void check_against(const MapToRefine& map, const MapToRefine& other, double tolerance_px,
                   Execution& execution) {
  if (map.disparity_y_px == nullptr) {
    cross_check(map.disparity_px->view(),
                other.check_px.empty() ? other.disparity_px->view() : other.check_px, map.side,
                tolerance_px, execution, *map.unmatched);
    return;
  }
  cross_check({map.disparity_px->view(), map.disparity_y_px->view()},
              {other.disparity_px->view(), other.disparity_y_px->view()}, map.side, tolerance_px,
              execution, *map.unmatched);
}

ImageView<const float> second_component(const MapToRefine& map) {
  return map.disparity_y_px != nullptr ? map.disparity_y_px->view() : ImageView<const float>();
}

}  // namespace

void refine_maps(const RefinementOptions& options, const MapToRefine& map, const MapToRefine* other,
                 Execution& execution, RefinementWork& work,
                 const std::function<void(std::string_view)>& begin_step) {
  const std::array<const MapToRefine*, 2> both = {&map, other};
  std::span<const MapToRefine* const> maps(both.data(), other != nullptr ? 2 : 1);

  if (options.edge_snapping_px > 0) {
    begin_step("edge snapping");
    for (const MapToRefine* one : maps) {
      if (one->disparity_px == nullptr) {
        continue;
      }
      find_edges(*one->image, execution, work.edge_snapping);
      snap_discontinuities(work.edge_snapping.edges, options.edge_snapping_px, execution,
                           *one->disparity_px);
    }
  }
  // Both are checked before either is changed.
  const bool is_checked = options.cross_check && other != nullptr;
  if (is_checked) {
    begin_step("cross-check");
    if (map.is_result) {
      check_against(map, *other, options.cross_check_px, execution);
    }
    if (other->is_result) {
      check_against(*other, map, options.cross_check_px, execution);
    }
  }
  if (other != nullptr && !(map.is_result && other->is_result)) {
    maps = maps.subspan(map.is_result ? 0 : 1, map.is_result || other->is_result ? 1 : 0);
  }
  if (!is_checked) {
    for (const MapToRefine* one : maps) {
      mark_unknown(one->disparity_px->view(), execution, *one->unmatched);
    }
  }
  if (uses_confidence(options)) {
    begin_step("confidence");
    for (const MapToRefine* one : maps) {
      mark_unsure(one->confidence->view(), options.confidence_threshold, execution,
                  *one->unmatched);
    }
  }
  if (options.speckle_size_px > 1) {
    begin_step("speckles");
    execution.executor().parallel_for(static_cast<int>(maps.size()), [&](int index) {
      const MapToRefine& one = *maps[static_cast<std::size_t>(index)];
      mark_speckles(one.disparity_px->view(), second_component(one), options.speckle_size_px,
                    work.speckles[static_cast<std::size_t>(index)], *one.unmatched);
    });
  }
  if (options.surface_fit_px > 0) {
    begin_step("surface fit");
    for (const MapToRefine* one : maps) {
      fit_surface(*one->unmatched, options.surface_fit_px, one->search, execution, work.surface_fit,
                  *one->disparity_px);
      if (one->disparity_y_px != nullptr) {
        fit_surface(*one->unmatched, options.surface_fit_px, one->search_y, execution,
                    work.surface_fit, *one->disparity_y_px);
      }
    }
  }
  begin_step("fill");
  for (const MapToRefine* one : maps) {
    for (DisparityMap* map_px : {one->disparity_px, one->disparity_y_px}) {
      if (map_px == nullptr) {
        continue;
      }
      fill_unmatched(*one->unmatched, one->side, options.fill, execution, *map_px);
      if (options.fill == Fill::kMedian) {
        take_filled_medians(*one->unmatched, *one->image, execution, work.filled_medians, *map_px);
      }
    }
  }
}

}  // namespace vantage
