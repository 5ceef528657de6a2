#include "engine/matching/search/coarse_to_fine/coarse_to_fine.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>
#include <utility>

#include "engine/matching/aggregation/aggregation_table.h"
#include "engine/matching/levels/energy_format.h"
#include "engine/matching/levels/level_extents.h"
#include "engine/matching/levels/level_stages.h"
#include "engine/matching/levels/smooth_tiles.h"
#include "engine/matching/levels/stage_half_energies.h"
#include "engine/matching/levels/stage_level_likelihoods.h"
#include "engine/matching/search/coarse_to_fine/window_volume.h"
#include "scheduler/trace.h"

namespace vantage {
namespace {

/// Span names of the levels in traces.
constexpr std::array<std::string_view, 10> kLevelNames = {
    "level 0", "level 1", "level 2", "level 3", "level 4",
    "level 5", "level 6", "level 7", "level 8", "level 9"};

/// Reduces the costs of a coarse level to `rows` of the next coarser one. Rows need no strips,
/// because a cell reads one block only.
void reduce_rows(const MethodParameters& parameters, const LevelVolume& finer,
                 scheduler::Range rows, LevelVolume& coarser, Execution& execution) {
  const bool is_bayes = has_likelihoods(parameters);
  const auto weight = static_cast<float>(parameters.level_weight);
  const double slant_penalty = parameters.slant_penalty / steps_per_px(parameters);
  execution.for_each_band(rows.size(), [&](int first_row, int end_row) {
    std::vector<std::uint16_t> work(is_bayes ? static_cast<std::size_t>(finer.lanes()) : 0);
    for (int y = rows.begin + first_row; y < rows.begin + end_row; ++y) {
      if (is_bayes) {
        reduce_float_energy_row(finer, y, {0, coarser.extent().columns}, weight, slant_penalty,
                                work.data(), coarser);
      } else {
        reduce_half_energy_row(finer, y, coarser);
      }
    }
  });
}

/// regions: of the coarser level, for Bayesian diffusion; null: all.
void reduce_level(const MethodParameters& parameters, const LevelVolume& finer,
                  const std::vector<scheduler::Region>* regions, LevelVolume& coarser,
                  Execution& execution) {
  if (regions == nullptr) {
    reduce_rows(parameters, finer, coarser.extent().all_rows(), coarser, execution);
    return;
  }
  const auto weight = static_cast<float>(parameters.level_weight);
  const double slant_penalty = parameters.slant_penalty / steps_per_px(parameters);
  execution.executor().parallel_for(static_cast<int>(regions->size()), [&](int index) {
    const scheduler::Region& region = (*regions)[static_cast<std::size_t>(index)];
    std::vector<std::uint16_t> work(static_cast<std::size_t>(finer.lanes()));
    for (int y = region.rows.begin; y < region.rows.end; ++y) {
      reduce_float_energy_row(finer, y, region.columns, weight, slant_penalty, work.data(),
                              coarser);
    }
  });
}

/// The costs of coarse levels, band by band, from the images.
class BandedCosts {
 public:
  BandedCosts(const MethodParameters& parameters, const kernels::CandidateGeometry& geometry,
              const ChainInput& input, const MapOutputs& outputs, CoarseLevels& levels,
              Execution& execution, const std::function<void(const MatchChain&)>& run)
      : parameters_(parameters),
        geometry_(geometry),
        input_(input),
        outputs_(outputs),
        levels_(levels),
        execution_(execution),
        run_(run) {}

  /// Makes the costs of the finest level without bands.
  void make_whole_level() {
    const int level = levels_.bands().levels + 1;
    const int end = levels_.costs(level).extent().rows;
    const int step = levels_.bands().rows_of(level);
    for (int y = 0; y < end; y += step) {
      make(level, {y, std::min(y + step, end)});
    }
  }
  /// Runs the chain at `place`, a level with bands.
  void search(const ChainLevel& place, const kernels::CandidateGeometry& of_level) {
    const int end = place.costs->extent().rows;
    const int step = levels_.bands().rows_of(place.number);
    ChainLevel band = place;
    for (int y = 0; y < end; y += step) {
      band.rows = {y, std::min(y + step, end)};
      const MatchChain chain(parameters_, of_level, input_, outputs_, band);
      make(place.number, rows_of_source(chain.stages(), *band.rows));
      run_(chain);
    }
  }

 private:
  /// Makes `rows` of a level, and of those with bands the rows of finer levels that they come from.
  void make(int level, scheduler::Range rows) {
    std::vector<scheduler::Range> of_levels(static_cast<std::size_t>(level) + 1, rows);
    for (int finer = level - 1; finer >= 1; --finer) {
      const scheduler::Range coarser = of_levels[static_cast<std::size_t>(finer) + 1];
      of_levels[static_cast<std::size_t>(finer)] = {
          2 * coarser.begin, std::min(2 * coarser.end, levels_.costs(finer).extent().rows)};
    }
    for (int held = 1; held <= std::min(level, levels_.bands().levels); ++held) {
      levels_.costs(held).hold(of_levels[static_cast<std::size_t>(held)]);
    }
    run_(MatchChain(parameters_, geometry_, input_, outputs_,
                    {.reduced = &levels_.costs(1), .rows = of_levels[1]}));
    for (int coarser = 2; coarser <= level; ++coarser) {
      reduce_rows(parameters_, levels_.costs(coarser - 1),
                  of_levels[static_cast<std::size_t>(coarser)], levels_.costs(coarser), execution_);
    }
  }

  const MethodParameters& parameters_;
  const kernels::CandidateGeometry& geometry_;
  const ChainInput& input_;
  const MapOutputs& outputs_;
  CoarseLevels& levels_;
  Execution& execution_;
  const std::function<void(const MatchChain&)>& run_;
};

CandidateBlocks::SmoothTiles use_of_smooth_tiles(const CheckMap& check_map) {
  using enum CandidateBlocks::SmoothTiles;
  return check_map.disparity_px.empty() ? kIgnored : check_map.is_only ? kLeftOut : kMarked;
}

/// `map_px` may be `check_px`. tiles: the only ones to write; null: all.
void make_check_map(const TileMask& smooth, const TileMask* tiles,
                    ImageView<const std::int32_t> winners, int disparity_min,
                    ImageView<const float> map_px, ImageView<float> check_px,
                    Execution& execution) {
  const TileMask from_level = tiles != nullptr ? smooth.within(*tiles) : smooth;
  const TileMask from_map = tiles != nullptr ? smooth.inverse().within(*tiles) : smooth.inverse();
  execution.for_each_band(check_px.height(), [&](int first_row, int end_row) {
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

/// Share of a level's pixels that are searched. parts: null: all.
double share_of(const SearchedParts::OfLevel* parts, scheduler::Extent extent) {
  if (parts == nullptr) {
    return 1;
  }
  double pixels = 0;
  for (const scheduler::Region& region : parts->winners) {
    pixels += static_cast<double>(region.columns.size()) * region.rows.size();
  }
  return pixels / (static_cast<double>(extent.columns) * extent.rows);
}

/// What a check map is made from.
struct CheckSource {
  const TileMask* smooth = nullptr;            ///< of the image
  ImageView<const std::int32_t> winners = {};  ///< of level 1
};

/// The levels that are searched in windows. `smooth` is filled if there is a check map.
CheckSource search_fine_levels(const MethodParameters& parameters,
                               const kernels::CandidateGeometry& geometry, const ChainInput& input,
                               const MapOutputs& outputs,
                               const std::vector<scheduler::Extent>& extents, CoarseLevels& levels,
                               Execution& execution, const CoarseMap& coarse_map,
                               const CheckMap& check_map, const std::vector<VolumeWriter>& volumes,
                               const SearchedParts* parts, LevelCells& cells, TileMask& smooth) {
  const int from = levels.window_levels();
  const EnergyFormat format(parameters);
  const LevelBeliefs coarse(levels.result(from), levels.blocks(from),
                            std::as_const(levels.coarser_winners()).view(), geometry,
                            format.of_result().nats(format.steps_per_nat()));
  FineWindows windows(parameters, geometry, input, execution, levels.windows());
  const auto count = [&cells](const scheduler::Extent& extent, double share) {
    cells.finest_level = share * extent.columns * extent.rows * kernels::kWindowCandidates;
    cells.all_levels += cells.finest_level;
  };
  CheckSource source{.smooth = &smooth, .winners = std::as_const(levels.coarser_winners()).view()};
  if (from == 2) {
    const scheduler::Span span(kLevelNames[1]);
    Image<std::int32_t>& winners =
        coarse_map.level == 1 ? *coarse_map.winners : levels.windows().winners;
    const auto* const of_level = parts != nullptr ? parts->of(1) : nullptr;
    windows.search_level_1(coarse, extents[1], of_level != nullptr ? &of_level->winners : nullptr,
                           winners);
    source.winners = std::as_const(winners).view();
    if (const auto* const writer = find_writer(volumes, VolumeKind::kAggregated, 1)) {
      write_window_volume(levels.windows().state, geometry.count, *writer, execution);
    }
    count(extents[1], share_of(of_level, extents[1]));
  }
  if (coarse_map.is_only) {
    return source;
  }
  const scheduler::Span span(kLevelNames[0]);
  std::optional<TileMask> tiles;
  if (parts != nullptr) {
    tiles = parts->map;
  }
  if (!check_map.disparity_px.empty()) {
    smooth = smooth_tiles(source.winners, extents[0], geometry.steps_per_px, execution);
    if (check_map.is_only) {
      tiles = tiles ? smooth.inverse().within(*tiles) : smooth.inverse();
    }
  }
  const auto* const writer = find_writer(volumes, VolumeKind::kAggregated, 0);
  WindowState* const state = writer != nullptr ? &levels.windows().finest : nullptr;
  windows.search_level_0(from == 1 ? &coarse : nullptr, outputs, tiles ? &*tiles : nullptr, state);
  if (writer != nullptr) {
    write_window_volume(*state, geometry.count, *writer, execution);
  }
  count(extents[0], tiles ? tiles->share() : 1);
  return source;
}

}  // namespace

bool has_check_map(const MethodParameters& parameters, scheduler::Extent extent) {
  const std::size_t levels = level_extents(extent, parameters.levels).size();
  return window_level_count(parameters, levels) > 0 ||
         (pruned_level_count(parameters, levels) > 0 && at_level(parameters, 0).iterations <= 1);
}

LevelCells match_coarse_to_fine(const MethodParameters& parameters,
                                const kernels::CandidateGeometry& geometry, const ChainInput& input,
                                const MapOutputs& outputs, CoarseLevels& levels,
                                Execution& execution,
                                const std::function<void(const MatchChain&)>& run,
                                const CoarseMap& coarse_map, const CheckMap& check_map,
                                const std::vector<VolumeWriter>& volumes,
                                const SearchedParts* parts) {
  const auto extents =
      level_extents({geometry.width, outputs.disparity_px.height()}, parameters.levels);
  const int coarsest = static_cast<int>(extents.size()) - 1;
  const bool may_have_bands =
      !levels.keeps_costs() && volumes.empty() && input.sharing == CostSharing::kNone;
  levels.resize(
      parameters, extents, geometry.count,
      may_have_bands
          ? level_bands(extents, geometry.lanes(), level_cell_bytes(parameters),
                        execution.options().level_memory_bytes.value_or(kDefaultLevelBytes))
          : LevelBands());
  BandedCosts banded(parameters, geometry, input, outputs, levels, execution, run);
  const auto parts_of = [parts](int level) {
    return parts != nullptr ? parts->of(level) : nullptr;
  };
  if (coarsest > 0) {
    const scheduler::Span span("reduce");
    if (input.sharing == CostSharing::kUses) {
      levels.use_other_costs();
    } else if (levels.bands().levels > 0) {
      banded.make_whole_level();
    } else {
      run(MatchChain(
          parameters, geometry, input, outputs,
          {.reduced = &levels.costs(1),
           .reduced_right =
               input.sharing == CostSharing::kStores ? &levels.start_other_costs() : nullptr,
           .regions = parts != nullptr ? &parts->of(1)->costs : nullptr}));
    }
    for (int level = std::max(2, levels.bands().levels + 2); level <= coarsest; ++level) {
      const auto* const of_level = parts_of(level);
      reduce_level(parameters, levels.costs(level - 1),
                   of_level != nullptr ? &of_level->costs : nullptr, levels.costs(level),
                   execution);
    }
  }
  for (int level = 0; level <= coarsest; ++level) {
    if (const auto* const writer = find_writer(volumes, VolumeKind::kCosts, level)) {
      kernels::CandidateGeometry of_level = geometry;
      of_level.width = extents[static_cast<std::size_t>(level)].columns;
      run(MatchChain(parameters, of_level, input, outputs,
                     {.number = level,
                      .costs = level > 0 ? &levels.costs(level) : nullptr,
                      .volume = writer}));
    }
  }
  LevelCells cells;
  const int finest = coarse_map.is_only ? coarse_map.level : 0;
  for (int level = coarsest; level >= std::max(finest, levels.window_levels()); --level) {
    const scheduler::Span span(kLevelNames[static_cast<std::size_t>(level)]);
    const scheduler::Extent extent = extents[static_cast<std::size_t>(level)];
    kernels::CandidateGeometry of_level = geometry;
    of_level.width = extent.columns;
    ChainLevel place{.number = level,
                     .coarser = level < coarsest ? &levels.result(level + 1) : nullptr};
    if (levels.blocks(level) != nullptr) {
      levels.choose_blocks(
          level, geometry,
          level == 0 ? use_of_smooth_tiles(check_map) : CandidateBlocks::SmoothTiles::kIgnored,
          execution);
      place.blocks = levels.blocks(level);
      place.coarser_blocks = levels.blocks(level + 1);
    }
    const bool is_mapped = level > 0 && level == coarse_map.level;
    if (is_mapped || levels.needs_winners(level)) {
      place.winners = &levels.start_winners(level, is_mapped ? coarse_map.winners : nullptr);
    }
    if (level > 0) {
      place.costs = &levels.costs(level);
      place.result = &levels.start_result(level);
    }
    const auto* searched = parts_of(level);
    if (searched != nullptr && searched->has_all_winners) {
      searched = nullptr;
    }
    std::vector<scheduler::Region> of_map;
    if (searched != nullptr) {
      place.regions = &searched->winners;
    } else if (level == 0 && parts != nullptr) {
      of_map = parts->map.regions();
      place.regions = &of_map;
    }
    place.volume = find_writer(volumes, VolumeKind::kAggregated, level);
    if (levels.bands().has(level)) {
      banded.search(place, of_level);
    } else {
      run(MatchChain(parameters, of_level, input, outputs, place));
    }
    cells.finest_level = place.blocks != nullptr
                             ? place.blocks->cells()
                             : static_cast<double>(extent.columns) * extent.rows * geometry.count;
    cells.finest_level *=
        level == 0 && parts != nullptr ? parts->map.share() : share_of(searched, extent);
    cells.all_levels += cells.finest_level;
  }
  TileMask smooth;
  CheckSource source;
  if (finest < levels.window_levels()) {
    source = search_fine_levels(parameters, geometry, input, outputs, extents, levels, execution,
                                coarse_map, check_map, volumes, parts, cells, smooth);
  } else if (!check_map.disparity_px.empty()) {
    source = {&levels.blocks(0)->smooth(), std::as_const(levels.coarser_winners()).view()};
  }
  if (!check_map.disparity_px.empty()) {
    make_check_map(*source.smooth, parts != nullptr ? &parts->map : nullptr, source.winners,
                   geometry.disparity_min, outputs.disparity_px, check_map.disparity_px, execution);
  }
  return cells;
}

}  // namespace vantage
