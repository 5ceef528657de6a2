#include "engine/matching/aggregation/stage_column_sum.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>

#include "engine/column_work.h"
#include "engine/matching/costs/cells_without_partner.h"
#include "kernels/column_sum/column_sum.h"

namespace vantage {
namespace {

using scheduler::Extent;
using scheduler::Range;

class ColumnSumStage : public scheduler::RowStage {
 public:
  ColumnSumStage(const kernels::CandidateGeometry& geometry, int height, int radius, float offset,
                 float scale)
      : RowStage({geometry.width, height}),
        geometry_(geometry),
        radius_(radius),
        offset_(offset),
        scale_(scale) {}

  [[nodiscard]] std::string_view name() const override { return "column sum"; }
  [[nodiscard]] std::size_t bytes_per_column() const override {
    return sizeof(std::int32_t) * static_cast<std::size_t>(geometry_.lanes());
  }
  /// The window and the row that just left it.
  [[nodiscard]] Range input_rows(int y, Extent input) const override {
    return {std::max(0, y - radius_ - 1), std::min(input.rows, y + radius_ + 1)};
  }
  [[nodiscard]] int window_rows() const override { return 2 * radius_ + 2; }
  [[nodiscard]] int first_row_work() const override {
    return std::min(2 * radius_ + 1, extent().rows);
  }
  [[nodiscard]] scheduler::ColumnWork column_work() const override {
    return vantage::column_work(kernels::kColumnSumWork, geometry_.count);
  }

  void make_row(const scheduler::RowTask& task) const override {
    auto* sums = reinterpret_cast<std::int32_t*>(task.output);
    kernels::ColumnSum row;
    row.offset = offset_;
    row.scale = scale_;
    row.count = task.columns.size() * geometry_.lanes();
    if (task.sweep_begins) {
      std::memset(sums, 0, bytes_per_column() * static_cast<std::size_t>(task.columns.size()));
      for (int y = std::max(0, task.y - radius_); y < task.input.rows().end; ++y) {
        row.entering = window_row(task, y, 0);
        kernels::column_sum_row(row, sums, sums);
      }
    } else {
      row.entering = window_row(task, task.y + radius_, 0);
      row.leaving = window_row(task, task.y - radius_ - 1, 1);
      kernels::column_sum_row(row, reinterpret_cast<const std::int32_t*>(task.previous), sums);
    }
    clear_columns(task.columns, sums);
  }

 protected:
  [[nodiscard]] const kernels::CandidateGeometry& geometry() const { return geometry_; }
  [[nodiscard]] int radius() const { return radius_; }
  /// A cost that contributes 0 to sums.
  [[nodiscard]] float nothing() const { return -offset_; }
  /// Costs of input row y for the output columns; null: nothing to add. `place`: 0 or 1; two rows
  /// with the same place are never used together.
  [[nodiscard]] virtual const float* window_row(const scheduler::RowTask& task, int y,
                                                int /*place*/) const {
    return input_row(task, y);
  }
  virtual void clear_columns(Range columns, std::int32_t* sums) const {
    clear_without_partner(geometry_, radius_, columns, geometry_.lanes(), sums);
  }
  /// The output columns of input row y; null outside the image.
  [[nodiscard]] const float* input_row(const scheduler::RowTask& task, int y) const {
    if (y < 0 || y >= extent().rows) {
      return nullptr;
    }
    return task.input.row<float>(y) +
           static_cast<std::ptrdiff_t>(task.columns.begin - task.input.columns().begin) *
               geometry_.lanes();
  }

 private:
  kernels::CandidateGeometry geometry_;
  int radius_;
  float offset_;
  float scale_;
};

class DisplacementSumStage final : public ColumnSumStage {
 public:
  DisplacementSumStage(const DisplacementGrid& grid, int radius, float offset, float scale)
      : ColumnSumStage(grid.columns(), grid.height, radius, offset, scale), grid_(grid) {}

  /// An entering and a leaving row, with the costs that do not count removed.
  [[nodiscard]] std::size_t state_bytes(Range columns, Extent /*input*/) const override {
    return 2 * bytes_per_column() * static_cast<std::size_t>(columns.size());
  }

 protected:
  [[nodiscard]] const float* window_row(const scheduler::RowTask& task, int y,
                                        int place) const override {
    const float* const costs = input_row(task, y);
    const kernels::CandidateRange inside = grid_.rows_with_partner(y);
    if (costs == nullptr || inside.empty()) {
      return nullptr;
    }
    if (inside.end - inside.begin == grid_.rows) {
      return costs;
    }
    const std::ptrdiff_t lanes = geometry().lanes();
    const std::ptrdiff_t cells = task.columns.size() * lanes;
    auto* const counted = reinterpret_cast<float*>(task.state) + place * cells;
    std::fill_n(counted, cells, nothing());
    const std::ptrdiff_t first = static_cast<std::ptrdiff_t>(inside.begin) * grid_.along_rows.count;
    const int count = (inside.end - inside.begin) * grid_.along_rows.count;
    for (std::ptrdiff_t column = 0; column < cells; column += lanes) {
      std::copy_n(costs + column + first, count, counted + column + first);
    }
    return counted;
  }
  void clear_columns(Range columns, std::int32_t* sums) const override {
    for (int row = 0; row < grid_.rows; ++row) {
      clear_without_partner(grid_.along_rows, radius(), columns, geometry().lanes(),
                            sums + static_cast<std::ptrdiff_t>(row) * grid_.along_rows.count);
    }
  }

 private:
  DisplacementGrid grid_;
};

}  // namespace

ColumnSumScale column_sum_scale(float min, float max, int window_px) {
  const float offset = -min;
  const double cost_range = max + offset;  // as rounded by the kernel
  if (!(cost_range > 0)) {
    return {offset, 1};
  }
  // Rounding can add half a unit per cost.
  const double samples = static_cast<double>(window_px) * window_px;
  const double limit = std::min(static_cast<double>(kernels::kColumnSumCellLimit),
                                std::numeric_limits<std::int32_t>::max() / samples) -
                       0.5;
  // Beyond 2^100 a scale would only resolve rounding errors and leave the range of floats.
  int exponent = std::min(100, std::ilogb(limit / cost_range));
  if (std::ldexp(cost_range, exponent) >= limit) {
    --exponent;
  }
  return {offset, static_cast<float>(std::ldexp(1.0, exponent))};
}

std::unique_ptr<scheduler::RowStage> make_column_sum_stage(
    const kernels::CandidateGeometry& geometry, int height, int radius, float offset, float scale) {
  return std::make_unique<ColumnSumStage>(geometry, height, radius, offset, scale);
}

std::unique_ptr<scheduler::RowStage> make_displacement_sum_stage(const DisplacementGrid& grid,
                                                                 int radius, float offset,
                                                                 float scale) {
  return std::make_unique<DisplacementSumStage>(grid, radius, offset, scale);
}

}  // namespace vantage
