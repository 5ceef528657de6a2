#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "scheduler/row_stage.h"

namespace vantage::scheduler {

/// Cells of all test stages: one cache line of floats or of integers a column.
inline constexpr int kCellLanes = 16;
using FloatCell = float[kCellLanes];
using IntCell = std::int32_t[kCellLanes];
static_assert(sizeof(FloatCell) == 64 && sizeof(IntCell) == 64);

/// A value for each (x, y, lane), unlike any neighbour.
inline std::uint32_t hash(int x, int y, int lane) {
  auto h = static_cast<std::uint32_t>(x) * 0x9E3779B1U +
           static_cast<std::uint32_t>(y) * 0x85EBCA77U +
           static_cast<std::uint32_t>(lane) * 0xC2B2AE3DU;
  h ^= h >> 15U;
  h *= 0x2C1B3C6DU;
  h ^= h >> 12U;
  h *= 0x297A2D39U;
  return h ^ (h >> 15U);
}
inline float hashed_float(int x, int y, int lane) {
  return static_cast<float>(hash(x, y, lane) % 1000003U) / 997.0F;
}
inline std::int32_t hashed_int(int x, int y, int lane) {
  return static_cast<std::int32_t>(hash(x, y, lane) % 65536U);
}

/// A stage of one cache line a column, and how its cells are addressed by image column.
class CellStage : public RowStage {
 public:
  CellStage(std::string name, Extent extent) : RowStage(extent), name_(std::move(name)) {}
  [[nodiscard]] std::string_view name() const override { return name_; }
  [[nodiscard]] std::size_t bytes_per_column() const override { return sizeof(FloatCell); }

 protected:
  template <typename Cell>
  static Cell& out(const RowTask& task, int x) {
    return reinterpret_cast<Cell*>(task.output)[x - task.columns.begin];
  }
  template <typename Cell>
  static const Cell& in(const RowTask& task, int x, int y) {
    return task.input.row<Cell>(y)[x - task.input.columns().begin];
  }
  template <typename Cell>
  static const Cell& source(const RowTask& task, int x) {
    return task.source.row<Cell>(task.y)[x - task.source.columns().begin];
  }

 private:
  std::string name_;
};

/// (a) A source of hashed floats.
class FloatSource final : public CellStage {
 public:
  explicit FloatSource(Extent extent) : CellStage("float source", extent) {}
  void make_row(const RowTask& task) const override {
    for (int x = task.columns.begin; x < task.columns.end; ++x) {
      for (int i = 0; i < kCellLanes; ++i) {
        out<FloatCell>(task, x)[i] = hashed_float(x, task.y, i);
      }
    }
  }
};

/// (b) E + .15 · Σ (neighbour − E); neighbours outside the image are absent.
class Diffusion final : public CellStage {
 public:
  explicit Diffusion(Extent extent) : CellStage("diffusion", extent) {}
  [[nodiscard]] Range input_rows(int y, Extent input) const override {
    return Range{y, y + 1}.widened(1, input.all_rows());
  }
  [[nodiscard]] Range input_columns(Range columns, Extent input) const override {
    return columns.widened(1, input.all_columns());
  }
  [[nodiscard]] int window_rows() const override { return 3; }
  void make_row(const RowTask& task) const override {
    const int y = task.y;
    for (int x = task.columns.begin; x < task.columns.end; ++x) {
      const FloatCell& centre = in<FloatCell>(task, x, y);
      FloatCell sum = {};
      const auto add = [&](bool present, int column, int row) {
        if (present) {
          const FloatCell& neighbour = in<FloatCell>(task, column, row);
          for (int i = 0; i < kCellLanes; ++i) {
            sum[i] += neighbour[i] - centre[i];
          }
        }
      };
      add(y > 0, x, y - 1);
      add(x > 0, x - 1, y);
      add(x + 1 < extent().columns, x + 1, y);
      add(y + 1 < extent().rows, x, y + 1);
      for (int i = 0; i < kCellLanes; ++i) {
        out<FloatCell>(task, x)[i] = centre[i] + 0.15F * sum[i];
      }
    }
  }
};

/// (c) The sum of a square window of floats, cut to the image, always added up in the same order.
class Box final : public CellStage {
 public:
  Box(int radius, Extent extent) : CellStage("box", extent), radius_(radius) {}
  [[nodiscard]] Range input_rows(int y, Extent input) const override {
    return Range{y, y + 1}.widened(radius_, input.all_rows());
  }
  [[nodiscard]] Range input_columns(Range columns, Extent input) const override {
    return columns.widened(radius_, input.all_columns());
  }
  [[nodiscard]] int window_rows() const override { return 2 * radius_ + 1; }
  void make_row(const RowTask& task) const override {
    for (int x = task.columns.begin; x < task.columns.end; ++x) {
      const Range columns = Range{x, x + 1}.widened(radius_, extent().all_columns());
      FloatCell sum = {};
      for (int row = task.input.rows().begin; row < task.input.rows().end; ++row) {
        for (int column = columns.begin; column < columns.end; ++column) {
          for (int i = 0; i < kCellLanes; ++i) {
            sum[i] += in<FloatCell>(task, column, row)[i];
          }
        }
      }
      std::copy(std::begin(sum), std::end(sum), out<FloatCell>(task, x));
    }
  }

 private:
  int radius_;
};

/// (d) Sums of hashed integers over 2 · radius + 1 rows, moved from row to row: a source that works
/// like the column sums of matching costs.
class RunningSum final : public CellStage {
 public:
  RunningSum(int radius, Extent extent) : CellStage("running sum", extent), radius_(radius) {}
  [[nodiscard]] int first_row_work() const override { return 2 * radius_ + 1; }
  void make_row(const RowTask& task) const override {
    const auto* previous = reinterpret_cast<const IntCell*>(task.previous);
    for (int x = task.columns.begin; x < task.columns.end; ++x) {
      for (int i = 0; i < kCellLanes; ++i) {
        std::int32_t sum = 0;
        if (task.sweep_begins) {
          for (int y = task.y - radius_; y <= task.y + radius_; ++y) {
            sum += value(x, y, i);
          }
        } else {
          sum = previous[x - task.columns.begin][i] + value(x, task.y + radius_, i) -
                value(x, task.y - radius_ - 1, i);
        }
        out<IntCell>(task, x)[i] = sum;
      }
    }
  }

 private:
  [[nodiscard]] std::int32_t value(int x, int y, int lane) const {
    return y >= 0 && y < extent().rows ? hashed_int(x, y, lane) : 0;
  }
  int radius_;
};

/// (e) Sums of floats over 2 · radius + 1 rows, moved from row to row in the stage's state. They
/// round, so they start anew at every kAnchorRows-th row whoever asks.
class AnchoredSum final : public CellStage {
 public:
  static constexpr int kAnchorRows = 8;

  AnchoredSum(int radius, Extent extent) : CellStage("anchored sum", extent), radius_(radius) {}
  [[nodiscard]] Range input_rows(int y, Extent input) const override {
    return {std::max(0, y - radius_ - 1), std::min(input.rows, y + radius_ + 1)};
  }
  [[nodiscard]] int window_rows() const override { return 2 * radius_ + 2; }
  [[nodiscard]] int first_row_work() const override { return 2 * radius_ + 1; }
  [[nodiscard]] std::size_t state_bytes(Range columns, Extent /*input*/) const override {
    return sizeof(FloatCell) * static_cast<std::size_t>(columns.size());
  }
  [[nodiscard]] int sweep_start(int y) const override { return y / kAnchorRows * kAnchorRows; }
  void make_row(const RowTask& task) const override {
    auto* sums = reinterpret_cast<FloatCell*>(task.state);
    const int y = task.y;
    if (y % kAnchorRows == 0) {
      std::fill_n(&sums[0][0], task.columns.size() * kCellLanes, 0.0F);
      for (int row = std::max(0, y - radius_); row < std::min(extent().rows, y + radius_ + 1);
           ++row) {
        add(task, row, 1.0F, sums);
      }
    } else {
      if (y + radius_ < extent().rows) {
        add(task, y + radius_, 1.0F, sums);
      }
      if (y - radius_ - 1 >= 0) {
        add(task, y - radius_ - 1, -1.0F, sums);
      }
    }
    std::memcpy(task.output, task.state, state_bytes(task.columns, {}));
  }

 private:
  static void add(const RowTask& task, int row, float sign, FloatCell* sums) {
    for (int x = task.columns.begin; x < task.columns.end; ++x) {
      for (int i = 0; i < kCellLanes; ++i) {
        sums[x - task.columns.begin][i] += sign * in<FloatCell>(task, x, row)[i];
      }
    }
  }
  int radius_;
};

/// (f) The mean of 2 × 2 cells, as far as they exist.
class Reduction final : public CellStage {
 public:
  explicit Reduction(Extent input)
      : CellStage("reduction", {(input.columns + 1) / 2, (input.rows + 1) / 2}) {}
  [[nodiscard]] Range input_rows(int y, Extent input) const override {
    return {2 * y, std::min(2 * y + 2, input.rows)};
  }
  [[nodiscard]] Range input_columns(Range columns, Extent input) const override {
    return {2 * columns.begin, std::min(2 * columns.end, input.columns)};
  }
  [[nodiscard]] int window_rows() const override { return 2; }
  void make_row(const RowTask& task) const override {
    for (int x = task.columns.begin; x < task.columns.end; ++x) {
      const int end = std::min(2 * x + 2, task.input.columns().end);
      const auto samples = static_cast<float>((end - 2 * x) * task.input.rows().size());
      for (int i = 0; i < kCellLanes; ++i) {
        float sum = 0;
        for (int row = task.input.rows().begin; row < task.input.rows().end; ++row) {
          for (int column = 2 * x; column < end; ++column) {
            sum += in<FloatCell>(task, column, row)[i];
          }
        }
        out<FloatCell>(task, x)[i] = sum / samples;
      }
    }
  }
};

/// (f) Twice as many rows and columns, odd ones half way between their neighbours.
class Expansion final : public CellStage {
 public:
  explicit Expansion(Extent extent) : CellStage("expansion", extent) {}
  [[nodiscard]] Range input_rows(int y, Extent input) const override {
    return {y / 2, std::min(y / 2 + 1 + y % 2, input.rows)};
  }
  [[nodiscard]] Range input_columns(Range columns, Extent input) const override {
    const int last = columns.end - 1;
    return {columns.begin / 2, std::min(last / 2 + 1 + last % 2, input.columns)};
  }
  [[nodiscard]] int window_rows() const override { return 2; }
  void make_row(const RowTask& task) const override {
    const int above = task.input.rows().begin;
    const int below = task.input.rows().end - 1;
    for (int x = task.columns.begin; x < task.columns.end; ++x) {
      const int left = x / 2;
      const int right = std::min(left + x % 2, task.input.columns().end - 1);
      for (int i = 0; i < kCellLanes; ++i) {
        out<FloatCell>(task, x)[i] =
            ((in<FloatCell>(task, left, above)[i] + in<FloatCell>(task, right, above)[i]) +
             (in<FloatCell>(task, left, below)[i] + in<FloatCell>(task, right, below)[i])) /
            4;
      }
    }
  }
};

/// (g) A sum of all cells at most `above` rows up, `below` rows down and a column aside, and of the
/// source if it is read, each with an odd factor of its own place, modulo 2³²: one wrong cell
/// anywhere, and everything that hangs on it comes out wrong.
class Mixture final : public CellStage {
 public:
  Mixture(int above, int below, bool reads_source, Extent extent)
      : CellStage("mixture", extent), above_(above), below_(below), reads_source_(reads_source) {}
  [[nodiscard]] Range input_rows(int y, Extent input) const override {
    return {std::max(0, y - above_), std::min(input.rows, y + below_ + 1)};
  }
  [[nodiscard]] Range input_columns(Range columns, Extent input) const override {
    return columns.widened(1, input.all_columns());
  }
  [[nodiscard]] int window_rows() const override { return above_ + below_ + 1; }
  [[nodiscard]] bool reads_source() const override { return reads_source_; }
  void make_row(const RowTask& task) const override {
    for (int x = task.columns.begin; x < task.columns.end; ++x) {
      const Range columns = Range{x, x + 1}.widened(1, extent().all_columns());
      std::uint32_t sum[kCellLanes] = {};
      for (int i = 0; reads_source_ && i < kCellLanes; ++i) {
        sum[i] = 101U * unsigned_cell(source<IntCell>(task, x)[i]);
      }
      for (int row = task.input.rows().begin; row < task.input.rows().end; ++row) {
        for (int column = columns.begin; column < columns.end; ++column) {
          const std::uint32_t weight = factor(column - x, row - task.y);
          for (int i = 0; i < kCellLanes; ++i) {
            sum[i] += weight * unsigned_cell(in<IntCell>(task, column, row)[i]);
          }
        }
      }
      std::memcpy(out<IntCell>(task, x), sum, sizeof(sum));
    }
  }
  static std::uint32_t factor(int dx, int dy) { return hash(dx, dy, 0) | 1U; }
  static std::uint32_t unsigned_cell(std::int32_t value) {
    return static_cast<std::uint32_t>(value);
  }

 private:
  int above_;
  int below_;
  bool reads_source_;
};

/// (h) Half way between its input and the source, in floats.
class PullToSource final : public CellStage {
 public:
  explicit PullToSource(Extent extent) : CellStage("pull to source", extent) {}
  [[nodiscard]] bool reads_source() const override { return true; }
  void make_row(const RowTask& task) const override {
    for (int x = task.columns.begin; x < task.columns.end; ++x) {
      for (int i = 0; i < kCellLanes; ++i) {
        out<FloatCell>(task, x)[i] =
            0.5F * in<FloatCell>(task, x, task.y)[i] + 0.5F * source<FloatCell>(task, x)[i];
      }
    }
  }
};

/// (i) A last stage: stores the rows it gets and counts how often each cell came.
class Sink final : public RowStage {
 public:
  explicit Sink(Extent extent)
      : RowStage(extent),
        cells_(static_cast<std::size_t>(extent.columns) * static_cast<std::size_t>(extent.rows) *
               sizeof(FloatCell)),
        visits_(cells_.size() / sizeof(FloatCell)) {}
  [[nodiscard]] std::string_view name() const override { return "sink"; }
  [[nodiscard]] std::size_t bytes_per_column() const override { return 0; }
  void make_row(const RowTask& task) const override {
    const std::size_t first =
        static_cast<std::size_t>(task.y) * static_cast<std::size_t>(extent().columns) +
        static_cast<std::size_t>(task.columns.begin);
    const auto* input =
        task.input.row<FloatCell>(task.y) + (task.columns.begin - task.input.columns().begin);
    std::memcpy(cells_.data() + first * sizeof(FloatCell), input,
                static_cast<std::size_t>(task.columns.size()) * sizeof(FloatCell));
    for (std::size_t k = 0; k < static_cast<std::size_t>(task.columns.size()); ++k) {
      ++visits_[first + k];
    }
  }
  [[nodiscard]] const std::vector<std::byte>& cells() const { return cells_; }
  [[nodiscard]] bool every_cell_came_once() const {
    return std::all_of(visits_.begin(), visits_.end(), [](int visits) { return visits == 1; });
  }
  void forget() {
    std::fill(cells_.begin(), cells_.end(), std::byte{0});
    std::fill(visits_.begin(), visits_.end(), 0);
  }

 private:
  mutable std::vector<std::byte> cells_;  // where results go: each cell is written by one task
  mutable std::vector<int> visits_;
};

/// Passes another stage on and checks what the executor promises it: alignment, the rows and
/// columns asked for, and sweeps that go down row by row with the same state.
class Supervised final : public RowStage {
 public:
  Supervised(const RowStage& inner, Extent input)
      : RowStage(inner.extent()), inner_(inner), input_(input) {}
  [[nodiscard]] std::string_view name() const override { return inner_.name(); }
  [[nodiscard]] std::size_t bytes_per_column() const override { return inner_.bytes_per_column(); }
  [[nodiscard]] Range input_rows(int y, Extent input) const override {
    return inner_.input_rows(y, input);
  }
  [[nodiscard]] Range input_columns(Range columns, Extent input) const override {
    return inner_.input_columns(columns, input);
  }
  [[nodiscard]] int window_rows() const override { return inner_.window_rows(); }
  [[nodiscard]] bool reads_source() const override { return inner_.reads_source(); }
  [[nodiscard]] int first_row_work() const override { return inner_.first_row_work(); }
  [[nodiscard]] int sweep_start(int y) const override { return inner_.sweep_start(y); }
  [[nodiscard]] std::size_t state_bytes(Range columns, Extent input) const override {
    require(input == input_, "state is asked for with another input");
    return inner_state_bytes(columns) + sizeof(int);
  }
  void make_row(const RowTask& task) const override {
    require(extent().all_rows().contains({task.y, task.y + 1}), "row outside the image");
    require(!task.columns.empty() && extent().all_columns().contains(task.columns),
            "columns outside the image");
    require(aligned(task.state), "state is not aligned");
    require(bytes_per_column() == 0 || aligned(task.output), "output is not aligned");
    require((task.previous == nullptr) == task.sweep_begins, "previous row without a sweep");
    int last_y = 0;
    std::byte* const own_state = task.state + inner_state_bytes(task.columns);
    std::memcpy(&last_y, own_state, sizeof(int));
    require(task.sweep_begins || last_y == task.y - 1, "a sweep skips rows");
    require(!task.sweep_begins || inner_.sweep_start(task.y) == task.y, "sweep begins elsewhere");
    std::memcpy(own_state, &task.y, sizeof(int));
    if (input_ != Extent{}) {
      const Range rows = inner_.input_rows(task.y, input_);
      require(task.input.rows() == rows, "other input rows than asked for");
      require(rows.size() <= inner_.window_rows(), "stage looks at more rows than it says");
      require(task.input.columns().contains(inner_.input_columns(task.columns, input_)),
              "input columns are missing");
      for (int y = rows.begin; y < rows.end; ++y) {
        require(aligned(task.input.row<std::byte>(y)), "input row is not aligned");
      }
    }
    if (inner_.reads_source()) {
      require(task.source.rows() == Range{task.y, task.y + 1}, "another row of the source");
      require(task.source.columns().contains(task.columns), "source columns are missing");
      require(aligned(task.source.row<std::byte>(task.y)), "source row is not aligned");
    }
    inner_.make_row(task);
  }

 private:
  [[nodiscard]] std::size_t inner_state_bytes(Range columns) const {
    return (inner_.state_bytes(columns, input_) + 63) / 64 * 64;
  }
  static bool aligned(const std::byte* memory) {
    return reinterpret_cast<std::uintptr_t>(memory) % 64 == 0;
  }
  void require(bool condition, const char* what) const {
    if (!condition) {
      throw std::logic_error(std::string(name()) + ": " + what);
    }
  }
  const RowStage& inner_;
  Extent input_;
};

}  // namespace vantage::scheduler
