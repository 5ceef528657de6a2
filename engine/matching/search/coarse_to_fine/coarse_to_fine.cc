#include "engine/matching/search/coarse_to_fine/coarse_to_fine.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>
#include <utility>

#include "engine/matching/levels/energy_format.h"
#include "engine/matching/levels/smooth_tiles.h"
#include "engine/matching/search/coarse_to_fine/window_volume.h"
#include "scheduler/trace.h"

namespace vantage {
namespace {

/// Span names of the levels in traces.
constexpr std::array<std::string_view, 10> kLevelNames = {
    "level 0", "level 1", "level 2", "level 3", "level 4",
    "level 5", "level 6", "level 7", "level 8", "level 9"};

CandidateBlocks::SmoothTiles use_of_smooth_tiles(const CheckMap& check_map) {
  using enum CandidateBlocks::SmoothTiles;
  return check_map.disparity_px.empty() ? kIgnored : check_map.is_only ? kLeftOut : kMarked;
}

/// Share of a level's pixels that are searched. parts: null: all.
double share_of(const SearchedParts::OfLevel* parts, scheduler::Extent extent) {
  if (parts == nullptr || parts->has_all_winners) {
    return 1;
  }
  double pixels = 0;
  for (const scheduler::Region& region : parts->winners) {
    pixels += static_cast<double>(region.columns.size()) * region.rows.size();
  }
  return pixels / (static_cast<double>(extent.columns) * extent.rows);
}

double pixels_of(scheduler::Extent extent) {
  return static_cast<double>(extent.columns) * extent.rows;
}

}  // namespace

LevelPlan CoarseToFine::plan(bool has_volumes) const {
  const bool may_have_bands =
      !levels_.keeps_costs() && !has_volumes && image_.input.sharing == CostSharing::kNone;
  return level_plan(
      image_.parameters, {image_.geometry.width, wanted_.outputs.disparity_px.height()},
      image_.geometry.count,
      may_have_bands ? execution_.options().level_memory_bytes.value_or(kDefaultLevelBytes)
                     : kWithoutBands);
}

kernels::CandidateGeometry CoarseToFine::geometry_of(int level) const {
  kernels::CandidateGeometry geometry = image_.geometry;
  geometry.width = levels_.plan().extent(level).columns;
  return geometry;
}

void CoarseToFine::count(double finest_cells) {
  cells_.finest_level = finest_cells;
  cells_.all_levels += finest_cells;
}

LevelCells CoarseToFine::search(const std::vector<VolumeWriter>& volumes) {
  levels_.resize(plan(!volumes.empty()));
  const LevelPlan& plan = levels_.plan();
  if (plan.coarsest() > 0) {
    const scheduler::Span span("reduce");
    costs_.make_levels(wanted_.parts);
  }
  write_costs(volumes);
  const int finest = wanted_.coarse.is_only ? wanted_.coarse.level : 0;
  for (int level = plan.coarsest(); level >= std::max(finest, plan.window_levels); --level) {
    search_level(level, find_writer(volumes, VolumeKind::kAggregated, level));
  }
  if (finest < plan.window_levels) {
    search_fine_levels(volumes);
  }
  if (has_check_map()) {
    const bool has_windows = plan.window_levels > 0;
    make_check_map(
        has_windows ? smooth_ : levels_.blocks(0)->smooth(),
        std::as_const(has_windows ? *level_1_winners_ : levels_.coarser_winners()).view());
  }
  return cells_;
}

void CoarseToFine::write_costs(const std::vector<VolumeWriter>& volumes) {
  for (int level = 0; level <= levels_.plan().coarsest(); ++level) {
    if (const auto* const writer = find_writer(volumes, VolumeKind::kCosts, level)) {
      run_(MatchChain(image_.parameters, geometry_of(level), image_.input, wanted_.outputs,
                      {.number = level,
                       .costs = level > 0 ? &levels_.costs(level) : nullptr,
                       .volume = writer}));
    }
  }
}

/// Where the chain of a level reads and writes, but for the parts to compute.
ChainLevel CoarseToFine::place_of(int level) {
  const LevelPlan& plan = levels_.plan();
  ChainLevel place{.number = level,
                   .coarser = level < plan.coarsest() ? &levels_.result(level + 1) : nullptr};
  if (levels_.blocks(level) != nullptr) {
    levels_.choose_blocks(
        level, image_.geometry,
        level == 0 ? use_of_smooth_tiles(wanted_.check) : CandidateBlocks::SmoothTiles::kIgnored,
        execution_);
    place.blocks = levels_.blocks(level);
    place.coarser_blocks = levels_.blocks(level + 1);
  }
  const bool is_mapped = level > 0 && level == wanted_.coarse.level;
  if (is_mapped || plan.needs_winners(level)) {
    place.winners = &levels_.start_winners(level, is_mapped ? wanted_.coarse.winners : nullptr);
  }
  if (level > 0) {
    place.costs = &levels_.costs(level);
    place.result = &levels_.start_result(level);
  }
  return place;
}

void CoarseToFine::search_level(int level, const VolumeWriter* volume) {
  const LevelPlan& plan = levels_.plan();
  std::optional<scheduler::Span> span;
  if (plan.coarsest() > 0) {
    span.emplace(kLevelNames[static_cast<std::size_t>(level)]);
  }
  ChainLevel place = place_of(level);
  place.volume = volume;
  const SearchedParts* const parts = wanted_.parts;
  const auto* const of_level = parts != nullptr ? parts->of(level) : nullptr;
  std::vector<scheduler::Region> of_map;
  if (level == 0 && parts != nullptr) {
    of_map = parts->map.regions();
    place.regions = &of_map;
  } else if (of_level != nullptr && !of_level->has_all_winners) {
    place.regions = &of_level->winners;
  }
  if (plan.bands.has(level)) {
    costs_.search_in_bands(place, geometry_of(level));
  } else {
    run_(MatchChain(image_.parameters, geometry_of(level), image_.input, wanted_.outputs, place));
  }
  const double cells = place.blocks != nullptr
                           ? place.blocks->cells()
                           : pixels_of(plan.extent(level)) * image_.geometry.count;
  count(cells * (level == 0 && parts != nullptr ? parts->map.share()
                                                : share_of(of_level, plan.extent(level))));
}

/// The levels that are searched in windows.
void CoarseToFine::search_fine_levels(const std::vector<VolumeWriter>& volumes) {
  const int from = levels_.plan().window_levels;
  const EnergyFormat format(image_.parameters);
  level_1_winners_ = &levels_.coarser_winners();
  const LevelBeliefs coarse(levels_.result(from), levels_.blocks(from), level_1_winners_->view(),
                            image_.geometry, format.of_result().nats(format.steps_per_nat()));
  FineWindows windows(image_.parameters, image_.geometry, image_.input, execution_,
                      levels_.windows());
  if (from == 2) {
    search_level_1(windows, coarse, find_writer(volumes, VolumeKind::kAggregated, 1));
  }
  if (!wanted_.coarse.is_only) {
    search_level_0(windows, from == 1 ? &coarse : nullptr,
                   find_writer(volumes, VolumeKind::kAggregated, 0));
  }
}

void CoarseToFine::search_level_1(FineWindows& windows, const CoarseBeliefs& coarse,
                                  const VolumeWriter* volume) {
  const scheduler::Span span(kLevelNames[1]);
  const scheduler::Extent extent = levels_.plan().extent(1);
  Image<std::int32_t>& winners =
      wanted_.coarse.level == 1 ? *wanted_.coarse.winners : levels_.windows().winners;
  const auto* const parts = wanted_.parts != nullptr ? wanted_.parts->of(1) : nullptr;
  windows.search_level_1(coarse, extent, parts != nullptr ? &parts->winners : nullptr, winners);
  level_1_winners_ = &winners;
  if (volume != nullptr) {
    write_window_volume(levels_.windows().state, image_.geometry.count, *volume, execution_);
  }
  count(share_of(parts, extent) * pixels_of(extent) * kernels::kWindowCandidates);
}

void CoarseToFine::search_level_0(FineWindows& windows, const CoarseBeliefs* coarse,
                                  const VolumeWriter* volume) {
  const scheduler::Span span(kLevelNames[0]);
  const scheduler::Extent extent = levels_.plan().extent(0);
  std::optional<TileMask> tiles;
  if (wanted_.parts != nullptr) {
    tiles = wanted_.parts->map;
  }
  if (has_check_map()) {
    smooth_ =
        smooth_tiles(level_1_winners_->view(), extent, image_.geometry.steps_per_px, execution_);
    if (wanted_.check.is_only) {
      tiles = tiles ? smooth_.inverse().within(*tiles) : smooth_.inverse();
    }
  }
  WindowState* const state = volume != nullptr ? &levels_.windows().finest : nullptr;
  windows.search_level_0(coarse, wanted_.outputs, tiles ? &*tiles : nullptr, state);
  if (volume != nullptr) {
    write_window_volume(*state, image_.geometry.count, *volume, execution_);
  }
  count((tiles ? tiles->share() : 1) * pixels_of(extent) * kernels::kWindowCandidates);
}

/// smooth: of the image; winners: of level 1. The map of the outputs may be the check map.
void CoarseToFine::make_check_map(const TileMask& smooth, ImageView<const std::int32_t> winners) {
  const TileMask* const tiles = wanted_.parts != nullptr ? &wanted_.parts->map : nullptr;
  const TileMask from_level = tiles != nullptr ? smooth.within(*tiles) : smooth;
  const TileMask from_map = tiles != nullptr ? smooth.inverse().within(*tiles) : smooth.inverse();
  const ImageView<const float> map_px = wanted_.outputs.disparity_px;
  const ImageView<float> check_px = wanted_.check.disparity_px;
  const int disparity_min = image_.geometry.disparity_min;
  execution_.for_each_band(check_px.height(), [&](int first_row, int end_row) {
    for (int y = first_row; y < end_row; ++y) {
      const std::int32_t* const of_row = winners.row(y / 2);
      float* const row = check_px.row(y);
      const int tile_y = smooth.row_of_pixel(y);
      from_map.for_each_run(tile_y, true, [&](scheduler::Range columns) {
        std::copy(map_px.row(y) + columns.begin, map_px.row(y) + columns.end, row + columns.begin);
      });
      from_level.for_each_run(tile_y, true, [&](scheduler::Range columns) {
        for (int x = columns.begin; x < columns.end; ++x) {
          row[x] = static_cast<float>(of_row[x / 2] + disparity_min);
        }
      });
    }
  });
}

}  // namespace vantage
