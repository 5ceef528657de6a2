#pragma once

#include <span>
#include <vector>

#include "scheduler/row_stage.h"

namespace vantage::scheduler {

/// A chain of stages in order; the stages belong to the caller.
using Chain = std::span<const RowStage* const>;

/// How many rows of its input above and below a stage reads to make a row. Not meaningful for
/// stages that change the number of rows.
struct RowReach {
  int above = 0;  ///< rows, including those from its sweep_start() on
  int below = 0;  ///< rows
};

/// The reach of each stage of `chain`: the maximum over all rows, as borders shorten it.
std::vector<RowReach> row_reaches(Chain chain);

/// Throws std::logic_error if a stage reads the source (RowStage::reads_source()) but cannot: the
/// first stage, and stages after one of another extent or after one that makes a row without
/// reading that row of its input.
void check_source_readers(Chain chain);

/// Extent of the input of stage `stage`: {} for the first one.
inline Extent input_extent(Chain chain, int stage) {
  return stage == 0 ? Extent{} : chain[static_cast<std::size_t>(stage) - 1]->extent();
}

/// The stages [first, end) of a chain as the sweeps of one pass run them.
struct PassStages {
  Chain stages;
  Extent input;  ///< of the stored rows that the first of them reads; {} for the first pass
  /// The chain's first stage, where a later pass reads the source: it runs beside the pass.
  const RowStage* source = nullptr;
  /// Rows of the chain's first stage to keep for stages that read them again; 0 if none does.
  int source_rows = 0;
};

PassStages pass_stages(Chain chain, int first, int end, int source_rows);

/// Required PassStages::source_rows for the stages [first, end). `reaches`: row_reaches(chain).
int source_rows_to_keep(Chain chain, const std::vector<RowReach>& reaches, int first, int end);

}  // namespace vantage::scheduler
