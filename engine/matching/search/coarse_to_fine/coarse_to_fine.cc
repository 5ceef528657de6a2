#include "engine/matching/search/coarse_to_fine/coarse_to_fine.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>

#include "engine/matching/levels/energy_format.h"
#include "engine/matching/levels/smooth_tiles.h"
#include "engine/matching/search/coarse_to_fine/window_volume.h"
#include "engine/matching/windows/window_level.h"
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
  const int finest = wanted_.coarse.level;
  for (int level = plan.coarsest(); level >= std::max(finest, plan.has_windows ? 1 : 0); --level) {
    search_level(level, find_writer(volumes, VolumeKind::kAggregated, level));
  }
  if (finest == 0 && plan.has_windows) {
    search_windows_of_image(find_writer(volumes, VolumeKind::kAggregated, 0));
  }
  if (has_check_map()) {
    make_check_map(plan.has_windows ? smooth_ : levels_.blocks(0)->smooth(),
                   levels_.coarser_winners().view());
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

/// Level 0, in windows around the winners of level 1.
void CoarseToFine::search_windows_of_image(const VolumeWriter* volume) {
  const scheduler::Span span(kLevelNames[0]);
  const scheduler::Extent extent = levels_.plan().extent(0);
  const ChainInput& input = image_.input;
  const EnergyFormat format(image_.parameters);
  const LevelBeliefs coarse(levels_.result(1), levels_.blocks(1), levels_.coarser_winners().view(),
                            image_.geometry, format.of_result().nats(format.steps_per_nat()));
  std::optional<TileMask> tiles;
  if (wanted_.parts != nullptr) {
    tiles = wanted_.parts->map;
  }
  if (has_check_map()) {
    smooth_ = smooth_tiles(levels_.coarser_winners().view(), extent, image_.geometry.steps_per_px,
                           execution_);
    if (wanted_.check.is_only) {
      tiles = tiles ? smooth_.inverse().within(*tiles) : smooth_.inverse();
    }
  }
  std::vector<scheduler::Region> regions;
  if (tiles) {
    regions = tiles->regions();
  }
  search_windows({.parameters = at_level(image_.parameters, 0),
                  .side = 1,
                  .spacing = 1,  // all levels have the image's candidates
                  .geometry = image_.geometry,
                  .reference = *input.reference,
                  .partner = *input.partners.front().image,
                  .edges = input.edges.empty() ? nullptr : &input.edges.front(),
                  .coarse = coarse,
                  .prior_px = input.prior_px,
                  .prior_weight = input.prior_weight},
                 image_.parameters.subpixel,
                 {.disparity_px = wanted_.outputs.disparity_px,
                  .confidence = wanted_.outputs.confidence,
                  .state = volume != nullptr ? &levels_.windows() : nullptr,
                  .regions = tiles ? &regions : nullptr},
                 execution_);
  if (volume != nullptr) {
    write_window_volume(levels_.windows(), image_.geometry.count, *volume, execution_);
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
