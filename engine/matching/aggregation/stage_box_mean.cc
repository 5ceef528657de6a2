#include "engine/matching/aggregation/stage_box_mean.h"

#include <algorithm>
#include <cstddef>
#include <string_view>

#include "engine/column_work.h"
#include "kernels/cell_smoothing/cell_smoothing.h"

namespace vantage {
namespace {

using scheduler::Extent;
using scheduler::Range;

/// The window in one direction: the mean of the runs of cells inside the image.
class BoxMeanStage : public scheduler::RowStage {
 public:
  BoxMeanStage(const kernels::CandidateGeometry& geometry, int height, int radius)
      : RowStage({geometry.width, height}),
        lanes_(geometry.lanes()),
        count_(geometry.count),
        radius_(radius) {}

  [[nodiscard]] std::string_view name() const override { return "box mean"; }
  [[nodiscard]] std::size_t bytes_per_column() const override {
    return sizeof(float) * static_cast<std::size_t>(lanes_);
  }
  /// Addresses and weights of the runs to sum.
  [[nodiscard]] std::size_t state_bytes(Range /*columns*/, Extent /*input*/) const override {
    const auto radius = static_cast<std::size_t>(radius_);
    return sizeof(const float*) * (2 * radius + 1) + sizeof(float) * (radius + 1);
  }
  [[nodiscard]] scheduler::ColumnWork column_work() const override {
    return vantage::column_work(kernels::symmetric_sum_work(radius_), count_);
  }

 protected:
  [[nodiscard]] int lanes() const { return lanes_; }
  [[nodiscard]] int radius() const { return radius_; }

  /// Means of `columns` columns over the positions within the radius of `middle` that lie in [0,
  /// end); address(position): the run there.
  template <typename Address>
  void mean(const scheduler::RowTask& task, int middle, int end, int columns,
            const Address& address, float* output) const {
    const auto** runs = reinterpret_cast<const float**>(task.state);
    auto* weights = reinterpret_cast<float*>(runs + 2 * radius_ + 1);
    const Range inside = Range{middle, middle + 1}.widened(radius_, {0, end});
    for (int k = -radius_; k <= radius_; ++k) {
      const int place = middle + k;
      runs[radius_ + k] = place >= 0 && place < end ? address(place) : nullptr;
    }
    std::fill_n(weights, radius_ + 1, 1.0F / static_cast<float>(inside.size()));
    kernels::symmetric_sum({runs, weights, radius_, columns * lanes_}, output);
  }

 private:
  int lanes_;
  int count_;
  int radius_;
};

class ColumnMeanStage final : public BoxMeanStage {
 public:
  using BoxMeanStage::BoxMeanStage;

  [[nodiscard]] Range input_rows(int y, Extent input) const override {
    return Range{y, y + 1}.widened(radius(), input.all_rows());
  }
  [[nodiscard]] int window_rows() const override { return 2 * radius() + 1; }

  void make_row(const scheduler::RowTask& task) const override {
    const std::ptrdiff_t first =
        static_cast<std::ptrdiff_t>(task.columns.begin - task.input.columns().begin) * lanes();
    const auto address = [&](int y) { return task.input.row<float>(y) + first; };
    mean(task, task.y, extent().rows, task.columns.size(), address,
         reinterpret_cast<float*>(task.output));
  }
};

class RowMeanStage final : public BoxMeanStage {
 public:
  using BoxMeanStage::BoxMeanStage;

  [[nodiscard]] Range input_columns(Range columns, Extent input) const override {
    return columns.widened(radius(), input.all_columns());
  }

  void make_row(const scheduler::RowTask& task) const override {
    const auto* cells = task.input.row<float>(task.y);
    auto* output = reinterpret_cast<float*>(task.output);
    for (int x = task.columns.begin; x < task.columns.end; ++x, output += lanes()) {
      const auto address = [&](int column) {
        return cells + static_cast<std::ptrdiff_t>(column - task.input.columns().begin) * lanes();
      };
      mean(task, x, extent().columns, 1, address, output);
    }
  }
};

}  // namespace

std::vector<std::unique_ptr<scheduler::RowStage>> make_box_mean_stages(
    const kernels::CandidateGeometry& geometry, int height, int radius) {
  std::vector<std::unique_ptr<scheduler::RowStage>> stages;
  stages.push_back(std::make_unique<ColumnMeanStage>(geometry, height, radius));
  stages.push_back(std::make_unique<RowMeanStage>(geometry, height, radius));
  return stages;
}

}  // namespace vantage
