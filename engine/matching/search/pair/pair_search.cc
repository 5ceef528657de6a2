#include "engine/matching/search/pair/pair_search.h"

#include <fmt/format.h>

#include <algorithm>
#include <new>

#include "engine/matching/chain/candidate_geometry.h"
#include "engine/matching/windows/window_level.h"
#include "engine/out_of_memory.h"
#include "kernels/symmetric_path/symmetric_path.h"

namespace vantage {

void PairMemory::add_use(MemoryUse& use) const {
  LevelMemory::add_use(use);
  use.add("prepared images", pair.grey_8.held_bytes() + pair.grey_float.held_bytes() +
                                 halves[0].held_bytes() + halves[1].held_bytes());
  use.add("symmetric energies", right_energies.held_bytes());
}

SearchPlan PairSearch::plan(const ResolvedMatchOptions& options, const MatchSize& size) {
  // Levels with lower and upper bounds or gradients, of both images, and mirrored copies.
  constexpr std::size_t kPlanes = 4 * 2;
  return full_size_plan(options, size, kPlanes);
}

void PairSearch::start() {
  const auto add = [this](Side side) {
    job_.tasks.push_back({.side = side,
                          .image = job_.images[index_of(side)].photograph,
                          .map = &job_.maps.of(side),
                          .name = side == Side::kLeft ? "match left" : "match right",
                          .is_result = job_.request.wants(side),
                          .wants_confidence = job_.wants_confidence(),
                          .volumes = job_.request.volumes});
  };
  // Symmetric: the right image's energies are stored, then the left image's chain selects (§3.17).
  const Side first = job_.is_symmetric() ? Side::kRight : Side::kLeft;
  add(first);
  add(other_side(first));
}

std::array<const Photograph*, 2> PairSearch::half_size_images() {
  for (const std::size_t i : {0, 1}) {
    own_.halves[i].prepare(*job_.images[i].photograph, 1, job_.execution);
  }
  return {&own_.halves[0].reduced(1), &own_.halves[1].reduced(1)};
}

void PairSearch::prepare() {
  const auto geometry =
      candidate_geometry(job_.options, Side::kLeft, job_.extent().columns, job_.extent().rows);
  const bool uses_pair = uses_column_ssd(job_.options.parameters) && !job_.options.disparities_y &&
                         !job_.request.uses_prior();
  const bool needs_costs = std::ranges::any_of(
      job_.request.volumes,
      [](const VolumeRequest& volume) { return volume.kind == VolumeKind::kCosts; });
  if (!uses_pair || needs_costs) {
    prepare_images(geometry);
  }
  if (uses_pair) {
    prepare_column_ssd(geometry);
  }
  for (const Side side : {Side::kLeft, Side::kRight}) {
    add_prior(side, inputs_[index_of(side)]);
  }
  if (can_share_costs()) {
    inputs_[0].sharing = CostSharing::kStores;
    inputs_[1].sharing = CostSharing::kUses;
  }
}

void PairSearch::prepare_images(const kernels::CandidateGeometry& geometry) {
  const bool needs_left = job_.task_of(Side::kLeft).need.whole;
  const bool needs_right = job_.task_of(Side::kRight).need.whole;
  // Windows read plain rows, with margins on both sides.
  const bool has_windows = job_.parameters.window_levels > 0;
  const auto margins = has_windows ? window_margins(geometry) : geometry;
  const int phases = sample_phases(1, geometry.steps_per_px);
  own_.images.resize(2);
  CostImage& left = own_.images[0];
  CostImage& right = own_.images[1];
  left.prepare(*job_.images[0].photograph, job_.parameters, margins,
               {.as_reference = needs_left,
                .as_partner_of_left = false,
                .as_partner_of_right = needs_right || has_windows,
                .phases = phases},
               job_.execution);
  right.prepare(*job_.images[1].photograph, job_.parameters, margins,
                {.as_reference = needs_right,
                 .as_partner_of_left = needs_left,
                 .as_partner_of_right = has_windows,
                 .phases = phases},
                job_.execution);
  inputs_ = {ChainInput{nullptr, &left, {CostPartner{&right}}},
             ChainInput{nullptr, &right, {CostPartner{&left}}}};
}

void PairSearch::prepare_column_ssd(const kernels::CandidateGeometry& geometry) {
  const int window_px = job_.options.parameters.window_px;
  own_.pair.prepare(*job_.images[0].photograph, *job_.images[1].photograph, geometry,
                    window_px * window_px,
                    {job_.task_of(Side::kLeft).need.whole, job_.task_of(Side::kRight).need.whole},
                    job_.execution);
  inputs_[0].pair = inputs_[1].pair = &own_.pair;
}

bool PairSearch::can_share_costs() const {
  const bool has_both =
      job_.task_of(Side::kLeft).need.whole && job_.task_of(Side::kRight).need.whole;
  return has_both && job_.previous == nullptr && !job_.is_symmetric() &&
         !job_.options.disparities_y &&
         shares_costs(job_.parameters, inputs_[0], job_.extent(),
                      candidate_count(job_.options.disparities, job_.parameters));
}

void PairSearch::search(MapTask& task) {
  if (job_.is_symmetric()) {
    start_symmetric(task);
  }
  search_levels(task, input_of(task));
}

void PairSearch::start_symmetric(const MapTask& task) {
  inputs_[index_of(task.side)].symmetric = &place_;
  const scheduler::Extent extent = job_.extent();
  if (task.side == Side::kLeft) {
    place_.is_stored = true;
    place_.right_outputs = {.disparity_px = job_.maps.right.disparity_px.view(),
                            .confidence = job_.maps.right.confidence.view()};
    return;
  }
  place_.right = &own_.right_energies;
  try {
    own_.right_energies.resize(
        extent, candidate_geometry(job_.options, Side::kLeft, extent.columns, extent.rows).lanes(),
        sizeof(kernels::StepEnergy));
  } catch (const std::bad_alloc&) {
    throw OutOfMemory(
        fmt::format("symmetric selection, which keeps {} MiB of energies ({}x{} pixels, {} "
                    "candidates)",
                    job_.plan.energy_bytes >> 20, extent.columns, extent.rows,
                    candidate_count(job_.options.disparities, job_.parameters)));
  }
}

void PairSearch::refine(RefinementWork& work) {
  if (own_.levels.plan().bands.levels > 0) {
    // Of very large images: refinement needs the memory.
    own_.levels = {};
    own_.images.clear();
  }
  if (!job_.options.refinement) {
    mark_all_unknown();
    return;
  }
  const MapToRefine left = to_refine(job_.task_of(Side::kLeft));
  const MapToRefine right = to_refine(job_.task_of(Side::kRight));
  refine_maps(*job_.options.refinement, left, &right, job_.execution, work,
              [this](std::string_view step) { start_stage(step); });
}

}  // namespace vantage
