#include "engine/matching/search/epipolar/epipolar_search.h"

#include <cmath>
#include <limits>

#include "engine/image/left_out.h"
#include "engine/matching/chain/candidate_geometry.h"

namespace vantage {

SearchPlan EpipolarSearch::plan(const ResolvedMatchOptions& options, const MatchSize& size) {
  ResolvedMatchOptions without_windows = options;
  without_windows.parameters.window_levels = 0;
  // Levels with lower and upper bounds or gradients, of both images, and mirrored copies; samples
  // of the other image along and between its lines.
  constexpr std::size_t kPlanes =
      4 * 2 + 4 * static_cast<std::size_t>(EpipolarGrid::kPhases * EpipolarGrid::kPhases);
  SearchPlan plan = full_size_plan(without_windows, size, kPlanes);
  constexpr std::size_t kPlaceBytes = 2 * 16;  // of the pixels of both images
  plan.image_bytes += kPlaceBytes * size.pixels();
  return plan;
}

void EpipolarSearch::start() {
  job_.parameters.window_levels = 0;
  for (const Side side : {Side::kLeft, Side::kRight}) {
    job_.tasks.push_back({.side = side,
                          .image = job_.images[index_of(side)].photograph,
                          .map = &job_.maps.of(side),
                          .name = side == Side::kLeft ? "match left" : "match right",
                          .is_result = job_.request.wants(side),
                          .wants_confidence = job_.wants_confidence()});
  }
}

void EpipolarSearch::search(MapTask& task) {
  if (task.need.whole) {
    prepare_map(task);
    search_levels(task, input_);
  }
}

void EpipolarSearch::prepare_map(const MapTask& task) {
  const EpipolarGrid& grid = (*job_.grids)[index_of(task.side)];
  const SearchedPhotograph& other = job_.images[index_of(other_side(task.side))];
  const auto geometry =
      candidate_geometry(job_.options, Side::kLeft, task.image->width(), task.image->height());
  constexpr int kPhases = EpipolarGrid::kPhases;
  own_.images.resize(1 + kPhases);
  own_.images[0].prepare(
      *task.image, job_.parameters, geometry,
      {.as_reference = true, .as_partner_of_left = false, .as_partner_of_right = false},
      job_.execution);
  for (int down = 0; down < kPhases; ++down) {
    std::array<Photograph, kPhases> at_phases;
    for (int along = 0; along < kPhases; ++along) {
      grid.sample(*other.photograph, along, down, at_phases[static_cast<std::size_t>(along)],
                  job_.execution);
    }
    own_.images[static_cast<std::size_t>(down) + 1].prepare_samples(
        at_phases, job_.parameters, geometry,
        {.as_reference = false,
         .as_partner_of_left = task.side == Side::kLeft,
         .as_partner_of_right = task.side == Side::kRight},
        job_.execution);
  }
  input_ = {nullptr, &own_.images[0], {{.image = &own_.images[1], .epipolar = &grid}}};
}

/// Erases the disparities that the other map contradicts.
void EpipolarSearch::check(const MapTask& task, const DisparityMap& other_px) const {
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  const EpipolarGrid& grid = (*job_.grids)[index_of(task.side)];
  const double tolerance_px = job_.options.refinement->cross_check_px;
  const int direction = direction_of(task.side);
  DisparityMap& map_px = task.map->disparity_px;
  job_.execution.for_each_band(map_px.height(), [&](int first, int end) {
    for (int y = first; y < end; ++y) {
      for (int x = 0; x < map_px.width(); ++x) {
        float& own_px = map_px.at(x, y);
        const EpipolarGrid::Place& place = grid.place(x, y);
        const double shift = static_cast<double>(own_px) * EpipolarGrid::kPhases;
        const Eigen::Vector2d partner =
            grid.position_of(place.line, place.sample + direction * shift);
        const double column = std::floor(partner.x() + 0.5);
        const double row = std::floor(partner.y() + 0.5);
        const bool is_inside = place.has_line && column >= 0 && column < other_px.width() &&
                               row >= 0 && row < other_px.height();
        if (!is_inside || !(std::abs(other_px.at(static_cast<int>(column), static_cast<int>(row)) -
                                     own_px) < tolerance_px)) {
          own_px = kNaN;
        }
      }
    }
  });
}

void EpipolarSearch::refine(RefinementWork& work) {
  if (job_.is_checked()) {
    start_stage("cross-check");
    for (const MapTask& task : job_.tasks) {
      erase_left_out(task.image->left_out, *task.map);
    }
    const DisparityMap left_px = job_.maps.left.disparity_px.copy();
    for (const MapTask& task : job_.tasks) {
      if (task.is_result) {
        check(task, task.side == Side::kLeft ? job_.maps.right.disparity_px : left_px);
      }
    }
  }
  if (!job_.options.refinement) {
    mark_all_unknown();
    return;
  }
  for (const MapTask& task : job_.tasks) {
    if (task.is_result) {
      refine_maps(*job_.options.refinement, to_refine(task), nullptr, job_.execution, work,
                  [this](std::string_view step) { start_stage(step); });
    }
  }
}

}  // namespace vantage
