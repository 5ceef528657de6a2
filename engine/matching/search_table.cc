#include "engine/matching/search_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>

#include "engine/error.h"
#include "engine/matching/noise/noise_filter.h"
#include "engine/matching/search/epipolar/epipolar_search.h"
#include "engine/matching/search/reduced/reduction.h"

namespace vantage {
namespace {

/// A search that lends its memory from a pool.
template <typename Search, typename Memory, typename... Args>
std::shared_ptr<MapSearch> lending(SearchJob& job, ObjectPool<Memory>& pool, Args&... args) {
  using Loan = typename ObjectPool<Memory>::Loan;
  const std::shared_ptr<Loan> loan(new Loan(pool.borrow()));
  return {new Search(job, **loan, args...), [loan](MapSearch* search) { delete search; }};
}

std::shared_ptr<MapSearch> start_pair(SearchJob& job, SearchPools& pools) {
  return lending<PairSearch>(job, pools.pair);
}

constexpr std::array<SearchEntry, 5> kSearches = {{
    {.abilities = {.name = "along epipolar lines",
                   .no_vertical_range = "disparities-y is set, expected none along epipolar lines",
                   .no_symmetric_selection =
                       "selection is symmetric, expected winner or scanline along epipolar lines: "
                       "pixels of both photographs lie on different ones"},
     .serves = [](const ResolvedMatchOptions&, const MatchSize& size) { return size.along_lines; },
     .plan = EpipolarSearch::plan,
     .start = [](SearchJob& job, SearchPools&) -> std::shared_ptr<MapSearch> {
       return std::make_shared<EpipolarSearch>(job);
     }},
    {.abilities = {.name = "several images",
                   .no_symmetric_selection =
                       "selection is symmetric, expected winner or scanline with several "
                       "baselines: a symmetric solution is of two images"},
     .serves = [](const ResolvedMatchOptions&,
                  const MatchSize& size) { return !size.baselines.empty(); },
     .plan = SeveralSearch::plan,
     .start = [](SearchJob& job,
                 SearchPools& pools) { return lending<SeveralSearch>(job, pools.several); }},
    {.abilities =
         {.name = "windows in reduced images",
          .no_prior = "there is a prior, expected none with a reduced search-size",
          .no_volumes =
              "there is no volume with a reduced search-size (preset realtime), which searches a "
              "few candidates around those of smaller images; expected search-size full",
          .reuse = true},
     .serves = [](const ResolvedMatchOptions& options,
                  const MatchSize& size) { return search_reductions(options, size.image) > 0; },
     .plan = ReducedSearch::plan,
     .start =
         [](SearchJob& job, SearchPools& pools) {
           return lending<ReducedSearch>(job, pools.reduced, pools.deferred_images);
         }},
    {.abilities = {.name = "coarse to fine", .reuse = true, .check_maps = true},
     .serves = [](const ResolvedMatchOptions& options,
                  const MatchSize&) { return options.parameters.levels > 1; },
     .plan = PairSearch::plan,
     .start = start_pair},
    {.abilities = {.name = "flat"},
     .serves = [](const ResolvedMatchOptions&, const MatchSize&) { return true; },
     .plan = PairSearch::plan,
     .start = start_pair},
}};

}  // namespace

void SearchPools::add_memory_use(MemoryUse& use) const {
  const auto add_idle = [&use](const auto& memory) { memory.add_use(use); };
  deferred_images.for_each_idle([&use](const DeferredMatch::Images& images) {
    use.add("prepared images", images[0].held_bytes() + images[1].held_bytes());
  });
  pair.for_each_idle(add_idle);
  several.for_each_idle(add_idle);
  reduced.for_each_idle(add_idle);
  refinement.for_each_idle(
      [&use](const RefinementWork& work) { use.add("refinement", held_bytes(work)); });
}

const SearchEntry& search_of(const ResolvedMatchOptions& options, const MatchSize& size) {
  return *std::ranges::find_if(
      kSearches, [&](const SearchEntry& entry) { return entry.serves(options, size); });
}

void require_abilities(const SearchAbilities& abilities, const ResolvedMatchOptions& options,
                       const MatchRequest& request) {
  const auto refuse = [](bool is_wanted, std::string_view why_not) {
    if (is_wanted && !why_not.empty()) {
      throw UsageError(std::string(why_not));
    }
  };
  refuse(options.disparities_y.has_value(), abilities.no_vertical_range);
  refuse(options.parameters.selection == Selection::kSymmetric, abilities.no_symmetric_selection);
  refuse(request.uses_prior(), abilities.no_prior);
  refuse(!request.volumes.empty(), abilities.no_volumes);
}

SearchPlan search_plan(const ResolvedMatchOptions& options, const MatchSize& size) {
  SearchPlan plan = search_of(options, size).plan(options, size);
  if (options.noise != 0) {
    const bool is_colour = options.parameters.colour == ColourUse::kChannels && size.channels >= 3;
    plan.image_bytes += smoothed_bytes(size.pixels(), is_colour ? 3 : 1,
                                       std::max<std::size_t>(2, size.baselines.size() + 1));
  }
  return plan;
}

std::string memory_obstacle(const ResolvedMatchOptions& options, const MatchSize& size,
                            std::size_t machine_bytes) {
  // A pair of bytes; maps and confidences of both images, what refinement keeps.
  const std::size_t of_pixel = 2 * static_cast<std::size_t>(size.channels) + 2 + 7 * sizeof(float);
  const std::size_t bytes = search_plan(options, size).bytes() + size.pixels() * of_pixel;
  if (machine_bytes == 0 || bytes <= machine_bytes) {
    return {};
  }
  const auto gib = [](std::size_t of_bytes) { return static_cast<double>(of_bytes) / (1 << 30); };
  const bool is_pair = size.baselines.empty() && !size.along_lines;
  return fmt::format(
      "{}x{} pixels with {} disparities need about {:.1f} GiB of memory, expected no more than the "
      "{:.1f} GiB of this machine: match tiles or fewer disparities{}",
      size.image.columns, size.image.rows, options.disparities.count(), gib(bytes),
      gib(machine_bytes),
      // Which searches several images, or along lines, at full size.
      is_pair ? ", or use the preset realtime" : "");
}

}  // namespace vantage
