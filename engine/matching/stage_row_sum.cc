#include "engine/matching/stage_row_sum.h"

#include <cstdint>

#include "kernels/row_sum/row_sum.h"

namespace vantage {
namespace {

using scheduler::Extent;
using scheduler::Range;

class RowSumStage final : public scheduler::RowStage {
 public:
  RowSumStage(int radius, int lanes, bool number_lanes, Extent extent)
      : RowStage(extent), radius_(radius), lanes_(lanes), number_lanes_(number_lanes) {}

  [[nodiscard]] std::string_view name() const override { return "row sum"; }
  [[nodiscard]] std::size_t bytes_per_column() const override {
    return sizeof(std::int32_t) * static_cast<std::size_t>(lanes_);
  }
  [[nodiscard]] Range input_columns(Range columns, Extent input) const override {
    return columns.widened(radius_, input.all_columns());
  }

  void make_row(const scheduler::RowTask& task) const override {
    const Range needed = input_columns(task.columns, extent());
    kernels::RowSum row;
    row.input = task.input.row<std::int32_t>(task.y) +
                static_cast<std::size_t>(needed.begin - task.input.columns().begin) *
                    static_cast<std::size_t>(lanes_);
    row.output = reinterpret_cast<std::int32_t*>(task.output);
    row.input_begin = needed.begin;
    row.input_end = needed.end;
    row.output_begin = task.columns.begin;
    row.output_end = task.columns.end;
    row.radius = radius_;
    row.lanes = lanes_;
    row.number_lanes = number_lanes_;
    kernels::row_sum(row);
  }

 private:
  int radius_;
  int lanes_;
  bool number_lanes_;
};

}  // namespace

std::unique_ptr<scheduler::RowStage> make_row_sum_stage(int radius, int lanes, bool number_lanes,
                                                        Extent extent) {
  return std::make_unique<RowSumStage>(radius, lanes, number_lanes, extent);
}

}  // namespace vantage
