#include "scheduler/chain_geometry.h"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace vantage::scheduler {

std::vector<RowReach> row_reaches(Chain chain) {
  std::vector<RowReach> reaches(chain.size());
  for (std::size_t k = 0; k < chain.size(); ++k) {
    const RowStage& stage = *chain[k];
    const Extent input = input_extent(chain, static_cast<int>(k));
    RowReach& reach = reaches[k];
    for (int y = 0; y < stage.extent().rows; ++y) {
      const int start = stage.sweep_start(y);
      if (k == 0) {
        reach.above = std::max(reach.above, y - start);
        continue;
      }
      reach.above = std::max(reach.above, y - stage.input_rows(start, input).begin);
      reach.below = std::max(reach.below, stage.input_rows(y, input).end - 1 - y);
    }
  }
  return reaches;
}

void check_source_readers(Chain chain) {
  std::size_t readers_end = 0;
  for (std::size_t k = 0; k < chain.size(); ++k) {
    if (chain[k]->reads_source()) {
      readers_end = k + 1;
    }
  }
  if (readers_end == 0) {
    return;
  }
  const auto fail = [](const RowStage& stage, const char* why) {
    throw std::logic_error("stage " + std::string(stage.name()) + ": " + why);
  };
  if (chain[0]->reads_source()) {
    fail(*chain[0], "is the source and reads it, expected a later stage");
  }
  const Extent extent = chain[0]->extent();
  for (std::size_t k = 1; k < readers_end; ++k) {
    if (chain[k]->extent() != extent) {
      fail(*chain[k], "has another extent than the source that is read again");
    }
    for (int y = 0; y < extent.rows; ++y) {
      if (!chain[k]->input_rows(y, extent).contains({y, y + 1})) {
        fail(*chain[k], "does not look at the row it makes, and the source is read again");
      }
    }
  }
}

PassStages pass_stages(Chain chain, int first, int end, int source_rows) {
  PassStages pass;
  pass.stages =
      chain.subspan(static_cast<std::size_t>(first), static_cast<std::size_t>(end - first));
  pass.input = input_extent(chain, first);
  pass.source = first > 0 && source_rows > 0 ? chain[0] : nullptr;
  pass.source_rows = source_rows;
  return pass;
}

int source_rows_to_keep(Chain chain, const std::vector<RowReach>& reaches, int first, int end) {
  // The stage after the source drives it, or the first reader where it runs beside a later pass. A
  // reader's row brings it as many rows farther as the stages after that one look down together.
  int rows = 0;
  int rows_below = 0;
  bool driven = first == 0;
  for (int k = std::max(first, 1); k < end; ++k) {
    if (driven) {
      rows_below += reaches[static_cast<std::size_t>(k)].below;
    }
    if (chain[static_cast<std::size_t>(k)]->reads_source()) {
      driven = true;
      rows = rows_below + 1;
    }
  }
  return std::min(rows, chain[0]->extent().rows);
}

}  // namespace vantage::scheduler
