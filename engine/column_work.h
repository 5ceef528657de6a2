#pragma once

#include "kernels/candidates.h"
#include "kernels/kernel_work.h"
#include "scheduler/row_stage.h"

namespace vantage {

/// Work of a kernel on one column of `count` candidates.
inline scheduler::ColumnWork column_work(const kernels::KernelWork& work, int count) {
  constexpr double kValueBytes = 4;
  const int lanes = kernels::CandidateGeometry{.count = count}.lanes();
  return {.cells = 1.0 * count,
          .operations = work.operations * count + work.operations_per_column,
          .bytes = kValueBytes * (work.values * lanes + work.values_per_column)};
}

}  // namespace vantage
