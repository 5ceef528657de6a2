#include "engine/refinement/refine_maps.h"

#include <span>

namespace vantage {
namespace {

void check_against(const MapToRefine& left, const MapToRefine& right, double tolerance_px,
                   Execution& execution) {
  if (left.disparity_y_px == nullptr) {
    cross_check(left.disparity_px->view(), right.disparity_px->view(), tolerance_px, execution,
                *left.unmatched, *right.unmatched);
    return;
  }
  cross_check({left.disparity_px->view(), left.disparity_y_px->view()},
              {right.disparity_px->view(), right.disparity_y_px->view()}, tolerance_px, execution,
              *left.unmatched, *right.unmatched);
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
      find_edges(*one->image, execution, work.edge_snapping);
      snap_discontinuities(work.edge_snapping.edges, options.edge_snapping_px, execution,
                           *one->disparity_px);
    }
  }
  if (options.cross_check && other != nullptr) {
    begin_step("cross-check");
    const bool is_left = map.side == MapSide::kLeft;
    check_against(is_left ? map : *other, is_left ? *other : map, options.cross_check_px,
                  execution);
  } else {
    for (const MapToRefine* one : maps) {
      mark_unknown(one->disparity_px->view(), execution, *one->unmatched);
    }
  }
  if (other != nullptr && !(map.is_result && other->is_result)) {
    maps = maps.subspan(map.is_result ? 0 : 1, 1);
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
      for (DisparityMap* map_px : {one->disparity_px, one->disparity_y_px}) {
        if (map_px != nullptr) {
          fit_surface(*one->unmatched, options.surface_fit_px, execution, work.surface_fit,
                      *map_px);
        }
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
