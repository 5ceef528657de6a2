#pragma once

#include <cstddef>

#include "scheduler/row_stage.h"

namespace vantage {

/// A selection whose disparities depend on all of a row's cells; its outputs are images.
class WholeRowStage : public scheduler::RowStage {
 public:
  using RowStage::RowStage;

  [[nodiscard]] std::size_t bytes_per_column() const override { return 0; }
  [[nodiscard]] bool needs_whole_rows() const override { return true; }
  [[nodiscard]] scheduler::Range input_columns(scheduler::Range /*columns*/,
                                               scheduler::Extent input) const override {
    return input.all_columns();
  }
};

}  // namespace vantage
