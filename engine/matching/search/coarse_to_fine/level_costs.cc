#include "engine/matching/search/coarse_to_fine/level_costs.h"

#include <algorithm>
#include <cstdint>

#include "engine/matching/aggregation/aggregation_table.h"
#include "engine/matching/levels/level_bands.h"
#include "engine/matching/levels/stage_half_energies.h"
#include "engine/matching/levels/stage_level_likelihoods.h"

namespace vantage {

using scheduler::Range;

void LevelCosts::make_levels(const SearchedParts* parts) {
  const LevelPlan& plan = levels_.plan();
  if (image_.input.sharing == CostSharing::kUses) {
    levels_.use_other_costs();
  } else {
    make_level_1(parts);
  }
  for (int level = std::max(2, plan.bands.levels + 2); level <= plan.coarsest(); ++level) {
    const auto* const of_level = parts != nullptr ? parts->of(level) : nullptr;
    if (of_level != nullptr) {
      reduce_regions(level, of_level->costs);
    } else {
      reduce_rows(level, plan.extent(level).all_rows());
    }
  }
}

/// With bands: the finest level without them instead.
void LevelCosts::make_level_1(const SearchedParts* parts) {
  const LevelBands bands = levels_.plan().bands;
  if (bands.levels > 0) {
    const int level = bands.levels + 1;
    const int end = levels_.plan().extent(level).rows;
    const int step = bands.rows_of(level);
    for (int y = 0; y < end; y += step) {
      make_rows(level, {y, std::min(y + step, end)});
    }
    return;
  }
  const bool stores_other = image_.input.sharing == CostSharing::kStores;
  run_(MatchChain(image_.parameters, image_.geometry, image_.input, size_,
                  {.reduced = &levels_.costs(1),
                   .reduced_right = stores_other ? &levels_.start_other_costs() : nullptr,
                   .regions = parts != nullptr ? &parts->of(1)->costs : nullptr}));
}

void LevelCosts::search_in_bands(const ChainLevel& place,
                                 const kernels::CandidateGeometry& geometry) {
  const int end = place.costs->extent().rows;
  const int step = levels_.plan().bands.rows_of(place.number);
  ChainLevel band = place;
  for (int y = 0; y < end; y += step) {
    band.rows = {y, std::min(y + step, end)};
    const MatchChain chain(image_.parameters, geometry, image_.input, size_, band);
    make_rows(place.number, rows_of_source(chain.stages(), *band.rows));
    run_(chain);
  }
}

/// Makes `rows` of a level, and of those with bands the rows of finer levels that they come from.
void LevelCosts::make_rows(int level, Range rows) {
  std::vector<Range> of_levels(static_cast<std::size_t>(level) + 1, rows);
  for (int finer = level - 1; finer >= 1; --finer) {
    const Range coarser = of_levels[static_cast<std::size_t>(finer) + 1];
    of_levels[static_cast<std::size_t>(finer)] = {
        2 * coarser.begin, std::min(2 * coarser.end, levels_.plan().extent(finer).rows)};
  }
  for (int held = 1; held <= std::min(level, levels_.plan().bands.levels); ++held) {
    levels_.costs(held).hold(of_levels[static_cast<std::size_t>(held)]);
  }
  run_(MatchChain(image_.parameters, image_.geometry, image_.input, size_,
                  {.reduced = &levels_.costs(1), .rows = of_levels[1]}));
  for (int coarser = 2; coarser <= level; ++coarser) {
    reduce_rows(coarser, of_levels[static_cast<std::size_t>(coarser)]);
  }
}

/// Makes rows of `level` ≥ 2. They need no strips, because a cell reads one block only.
void LevelCosts::reduce_rows(int level, Range rows) {
  const bool is_bayes = has_likelihoods(image_.parameters);
  LevelVolume& coarser = levels_.costs(level);
  const LevelVolume& finer = levels_.costs(level - 1);
  execution_.for_each_band(rows.size(), [&](int first_row, int end_row) {
    std::vector<std::uint16_t> work(is_bayes ? static_cast<std::size_t>(finer.lanes()) : 0);
    for (int y = rows.begin + first_row; y < rows.begin + end_row; ++y) {
      if (is_bayes) {
        reduce_energy_row(level, y, {0, coarser.extent().columns}, work.data());
      } else {
        reduce_half_energy_row(finer, y, coarser);
      }
    }
  });
}

/// The same for some regions, for Bayesian diffusion.
void LevelCosts::reduce_regions(int level, const std::vector<scheduler::Region>& regions) {
  execution_.executor().parallel_for(static_cast<int>(regions.size()), [&](int index) {
    const scheduler::Region& region = regions[static_cast<std::size_t>(index)];
    std::vector<std::uint16_t> work(static_cast<std::size_t>(levels_.plan().lanes()));
    for (int y = region.rows.begin; y < region.rows.end; ++y) {
      reduce_energy_row(level, y, region.columns, work.data());
    }
  });
}

void LevelCosts::reduce_energy_row(int level, int y, Range columns, std::uint16_t* work) {
  const MethodParameters& parameters = image_.parameters;
  reduce_float_energy_row(levels_.costs(level - 1), y, columns,
                          {.weight = static_cast<float>(parameters.level_weight),
                           .slant_penalty = parameters.slant_penalty / steps_per_px(parameters)},
                          work, levels_.costs(level));
}

}  // namespace vantage
