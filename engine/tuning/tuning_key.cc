#include "engine/tuning/tuning_key.h"

#include <fmt/format.h>

#include <cmath>
#include <string_view>

#include "engine/build_info.h"
#include "engine/matching/aggregation/aggregation_table.h"
#include "engine/matching/chain/match_chain.h"
#include "engine/matching/costs/cost_table.h"
#include "engine/matching/levels/energy_format.h"
#include "engine/matching/options/method_names.h"
#include "engine/simd.h"
#include "engine/thread_placement.h"

namespace vantage {
namespace {

std::string_view name_of(scheduler::ExecutorKind kind) {
  switch (kind) {
    case scheduler::ExecutorKind::kTbb:
      return "tbb";
    case scheduler::ExecutorKind::kOpenMp:
      return "openmp";
    case scheduler::ExecutorKind::kSerial:
      return "serial";
  }
  return "";
}

/// The power of 2^(1/`steps`) nearest to `value`, rounded; 0 stays 0.
long class_of(double value, int steps) {
  return value <= 0 ? 0 : std::lround(std::exp2(std::round(steps * std::log2(value)) / steps));
}

/// Reach of the aggregation, in its own unit.
std::string reach_of(const MethodParameters& parameters) {
  const auto reach_in = aggregation_of(parameters).reach;
  if (reach_in == nullptr) {
    return "";
  }
  const AggregationReach reach = reach_in(parameters);
  return fmt::format(" about {} {}", class_of(reach.amount, 1), reach.unit);
}

std::string method_text(const MatchOptions& match, const TunedImages& images) {
  const MethodParameters parameters = match.resolved();
  std::string text = fmt::format("{} {}{}", name_of(parameters.cost),
                                 name_of(parameters.aggregation), reach_of(parameters));
  if (const auto work_class = cost_of(parameters).work_class) {
    text += work_class(parameters);
  }
  if (uses_fixed_energies(parameters)) {
    text += ", largest term";  // cells are half as large and faster
  }
  if (parameters.aggregation == Aggregation::kBayes &&
      parameters.prior != Prior::kContaminatedGaussian) {
    text += fmt::format(", {} prior", name_of(parameters.prior));
  }
  if (parameters.levels > 1) {
    text += fmt::format(", {} levels", parameters.levels);
    if (parameters.window_levels > 0) {
      text += fmt::format(", windows on {}", parameters.window_levels);
    }
    if (parameters.candidate_blocks > 0) {
      text +=
          fmt::format(", {} blocks on {}", parameters.candidate_blocks, parameters.pruned_levels);
    }
  }
  if (parameters.selection != Selection::kWinner) {
    text += fmt::format(", {}", name_of(parameters.selection));
  }
  if (parameters.search_size != SearchSize::kFull) {
    text += ", reduced search";
  }
  if (uses_column_ssd(parameters) && !match.disparities_y) {
    text += images.is_8_bit_grey ? ", 8-bit grey" : ", any images";
  } else if (parameters.colour == ColourUse::kChannels) {
    text += ", channels";
  }
  return text;
}

}  // namespace

std::string TuningKey::text() const {
  return fmt::format("{}; {}; {}; {}; Vantage {}", machine, threads, method, size, version);
}

TuningKey make_tuning_key(const scheduler::Machine& machine, const MatchOptions& match,
                          const ExecutionOptions& execution, const TunedImages& images) {
  constexpr std::size_t kKib = 1024;
  constexpr int kRootsOfTwo = 2;
  TuningKey key;
  key.machine =
      fmt::format("{}, L1 {} KiB, L2 {} KiB, L3 {} KiB, {} threads on {} cores", machine.processor,
                  machine.l1_data_bytes / kKib, machine.l2_bytes / kKib, machine.l3_bytes / kKib,
                  machine.hardware_threads, machine.cores);
  if (machine.numa_nodes > 1) {
    key.machine += fmt::format(" of {} nodes", machine.numa_nodes);
  }
  key.threads = fmt::format("{} threads, {}, {}",
                            execution.threads ? std::to_string(*execution.threads) : "all",
                            name_of(execution.executor), instruction_set_in_use());
  if (execution.binding) {
    key.threads += fmt::format(", bound to {}", name_of(*execution.binding));
  }
  key.method = method_text(match, images);
  const int candidates = candidate_count(match.disparities, match.resolved()) *
                         (match.disparities_y ? match.disparities_y->count() : 1);
  key.size = fmt::format("about {}x{} pixels, {} {}", class_of(images.width_px, kRootsOfTwo),
                         class_of(images.height_px, kRootsOfTwo), class_of(candidates, kRootsOfTwo),
                         match.disparities_y ? "displacements" : "disparities");
  key.version = build_info().version;
  return key;
}

}  // namespace vantage
