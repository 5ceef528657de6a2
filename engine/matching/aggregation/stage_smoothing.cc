#include "engine/matching/aggregation/stage_smoothing.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

#include "engine/column_work.h"
#include "engine/matching/aggregation/smoothing_kernels.h"
#include "kernels/cell_smoothing/cell_smoothing.h"

namespace vantage {
namespace {

using scheduler::Extent;
using scheduler::Range;

/// Common base: float cells in and out, of the same size.
class SmoothingStage : public scheduler::RowStage {
 public:
  SmoothingStage(const kernels::CandidateGeometry& geometry, int height)
      : RowStage({geometry.width, height}), lanes_(geometry.lanes()), count_(geometry.count) {}

  [[nodiscard]] std::size_t bytes_per_column() const override {
    return sizeof(float) * static_cast<std::size_t>(lanes_);
  }

 protected:
  [[nodiscard]] int lanes() const { return lanes_; }
  [[nodiscard]] int count() const { return count_; }

  /// Column x of input row y, x in the requested columns; null outside the image.
  [[nodiscard]] const float* input_cells(const scheduler::RowTask& task, int x, int y) const {
    if (x < 0 || x >= extent().columns || y < 0 || y >= extent().rows) {
      return nullptr;
    }
    return task.input.row<float>(y) +
           static_cast<std::ptrdiff_t>(x - task.input.columns().begin) * lanes_;
  }

 private:
  int lanes_;
  int count_;
};

/// A symmetric kernel along one direction: its weights from the middle outwards, or so many equal
/// ones, whose sum inside the image is 1.
struct Kernel {
  std::vector<float> weights;
  bool is_mean = false;
};

class ConvolutionStage : public SmoothingStage {
 public:
  ConvolutionStage(const kernels::CandidateGeometry& geometry, int height, Kernel kernel)
      : SmoothingStage(geometry, height), kernel_(std::move(kernel)) {}

  /// Addresses of the runs to sum, and the weights of a mean.
  [[nodiscard]] std::size_t state_bytes(Range /*columns*/, Extent /*input*/) const override {
    const std::size_t weights = kernel_.weights.size();
    return sizeof(const float*) * (2 * weights - 1) +
           (kernel_.is_mean ? sizeof(float) * weights : 0);
  }
  [[nodiscard]] scheduler::ColumnWork column_work() const override {
    return vantage::column_work(kernels::symmetric_sum_work(radius()), count());
  }

 protected:
  [[nodiscard]] int radius() const { return static_cast<int>(kernel_.weights.size()) - 1; }
  [[nodiscard]] std::string_view name_or(std::string_view name) const {
    return kernel_.is_mean ? "box mean" : name;
  }

  /// The weighted sum of the runs address(−radius) … address(radius) of `columns` columns.
  template <typename Address>
  void sum(const scheduler::RowTask& task, const Address& address, int columns,
           float* output) const {
    const auto** runs = reinterpret_cast<const float**>(task.state);
    int inside = 0;
    for (int k = -radius(); k <= radius(); ++k) {
      runs[radius() + k] = address(k);
      inside += runs[radius() + k] != nullptr ? 1 : 0;
    }
    const float* weights = kernel_.weights.data();
    if (kernel_.is_mean) {
      auto* const equal = reinterpret_cast<float*>(runs + 2 * radius() + 1);
      std::fill_n(equal, radius() + 1, 1.0F / static_cast<float>(inside));
      weights = equal;
    }
    kernels::symmetric_sum({runs, weights, radius(), columns * lanes()}, output);
  }

 private:
  Kernel kernel_;
};

class RowConvolutionStage final : public ConvolutionStage {
 public:
  using ConvolutionStage::ConvolutionStage;

  [[nodiscard]] std::string_view name() const override {
    return name_or("convolution down columns");
  }
  [[nodiscard]] Range input_rows(int y, Extent input) const override {
    return Range{y, y + 1}.widened(radius(), input.all_rows());
  }
  [[nodiscard]] int window_rows() const override { return 2 * radius() + 1; }

  void make_row(const scheduler::RowTask& task) const override {
    const auto address = [&](int k) { return input_cells(task, task.columns.begin, task.y + k); };
    sum(task, address, task.columns.size(), reinterpret_cast<float*>(task.output));
  }
};

class ColumnConvolutionStage final : public ConvolutionStage {
 public:
  using ConvolutionStage::ConvolutionStage;

  [[nodiscard]] std::string_view name() const override { return name_or("convolution along rows"); }
  [[nodiscard]] Range input_columns(Range columns, Extent input) const override {
    return columns.widened(radius(), input.all_columns());
  }

  void make_row(const scheduler::RowTask& task) const override {
    // Columns that need no cell outside the image are summed together, the others one by one.
    const int inner_begin = std::clamp(radius(), task.columns.begin, task.columns.end);
    const int inner_end = std::clamp(extent().columns - radius(), inner_begin, task.columns.end);
    for (int x = task.columns.begin; x < task.columns.end;) {
      const int end = x == inner_begin && inner_begin < inner_end ? inner_end : x + 1;
      const auto address = [&](int k) { return input_cells(task, x + k, task.y); };
      sum(task, address, end - x,
          reinterpret_cast<float*>(task.output) +
              static_cast<std::ptrdiff_t>(x - task.columns.begin) * lanes());
      x = end;
    }
  }
};

/// Boxes of widths 3, 3, 3 and 5 in both directions.
class BoxCascadeStage final : public SmoothingStage {
 public:
  using SmoothingStage::SmoothingStage;

  [[nodiscard]] std::string_view name() const override { return "box cascade"; }
  [[nodiscard]] Range input_rows(int y, Extent input) const override {
    return Range{y, y + 1}.widened(kRadius, input.all_rows());
  }
  [[nodiscard]] Range input_columns(Range columns, Extent input) const override {
    return columns.widened(kRadius, input.all_columns());
  }
  [[nodiscard]] int window_rows() const override { return 2 * kRadius + 1; }
  [[nodiscard]] std::size_t state_bytes(Range columns, Extent input) const override {
    return bytes_per_column() * static_cast<std::size_t>(input_columns(columns, input).size());
  }
  [[nodiscard]] scheduler::ColumnWork column_work() const override {
    return vantage::column_work(kernels::kBoxCascadeWork, count());
  }

  void make_row(const scheduler::RowTask& task) const override {
    const Range input = input_columns(task.columns, extent());
    std::array<const float*, 2 * kRadius + 1> rows = {};
    for (int k = -kRadius; k <= kRadius; ++k) {
      rows[static_cast<std::size_t>(kRadius + k)] = input_cells(task, input.begin, task.y + k);
    }
    const kernels::BoxCascade cascade = {rows.data(),        input.begin,      input.end,
                                         task.columns.begin, task.columns.end, lanes()};
    kernels::box_cascade_row(cascade, reinterpret_cast<float*>(task.state),
                             reinterpret_cast<float*>(task.output));
  }

 private:
  static constexpr int kRadius = kernels::BoxCascade::kRadius;
};

std::vector<std::unique_ptr<scheduler::RowStage>> make_convolution_stages(
    const kernels::CandidateGeometry& geometry, int height, const Kernel& kernel) {
  std::vector<std::unique_ptr<scheduler::RowStage>> stages;
  stages.push_back(std::make_unique<RowConvolutionStage>(geometry, height, kernel));
  stages.push_back(std::make_unique<ColumnConvolutionStage>(geometry, height, kernel));
  return stages;
}

}  // namespace

std::vector<std::unique_ptr<scheduler::RowStage>> make_box_mean_stages(
    const kernels::CandidateGeometry& geometry, int height, int radius) {
  const std::vector<float> equal(static_cast<std::size_t>(radius) + 1);
  return make_convolution_stages(geometry, height, {equal, true});
}

std::vector<std::unique_ptr<scheduler::RowStage>> make_gaussian_stages(
    const kernels::CandidateGeometry& geometry, int height, double sigma_px) {
  return make_convolution_stages(geometry, height, {gaussian_kernel(sigma_px)});
}

std::vector<std::unique_ptr<scheduler::RowStage>> make_box_cascade_stages(
    const kernels::CandidateGeometry& geometry, int height, double sigma_px) {
  const std::array<int, 4> widths_px = box_cascade_widths_px(sigma_px);
  if (widths_px != kernels::BoxCascade::kWidths) {
    return make_convolution_stages(geometry, height, {box_cascade_kernel(widths_px)});
  }
  std::vector<std::unique_ptr<scheduler::RowStage>> stages;
  stages.push_back(std::make_unique<BoxCascadeStage>(geometry, height));
  return stages;
}

}  // namespace vantage
