#pragma once

#include <cstddef>
#include <string_view>

#include "scheduler/range.h"

namespace vantage::scheduler {

/// The rows of its input that a stage sees while it makes one row. Owned by the executor; valid
/// during the call. Rows are 64-byte aligned at the first column of columns().
class InputRows {
 public:
  InputRows() = default;
  /// Stored rows: row y lies at base + row_pitch · (y mod capacity_rows).
  InputRows(const std::byte* base, std::size_t row_pitch, int capacity_rows, Range rows,
            Range columns)
      : base_(base),
        row_pitch_(row_pitch),
        capacity_rows_(capacity_rows),
        rows_(rows),
        columns_(columns) {}
  /// The rows that may be asked for: what RowStage::input_rows() said, inside the image.
  [[nodiscard]] Range rows() const { return rows_; }
  [[nodiscard]] Range columns() const { return columns_; }

  /// First cell (column columns().begin) of input row y, y in rows().
  template <typename Cell>
  [[nodiscard]] const Cell* row(int y) const {
    return reinterpret_cast<const Cell*>(base_ +
                                         row_pitch_ * static_cast<std::size_t>(y % capacity_rows_));
  }

 private:
  const std::byte* base_ = nullptr;
  std::size_t row_pitch_ = 0;
  int capacity_rows_ = 1;
  Range rows_;
  Range columns_;
};

/// One row to be made.
struct RowTask {
  int y = 0;
  /// True for the first row of a sweep, when `state` is uninitialised. The sweep then continues
  /// with y + 1, y + 2, … and the same state.
  bool sweep_begins = false;
  InputRows input;              ///< empty for the first stage of a chain
  InputRows source;             ///< see RowStage::reads_source(); else empty
  Range columns;                ///< the columns to make
  std::byte* output = nullptr;  ///< first cell of column columns.begin; unused by a last stage
  /// The row this stage made just before in this sweep, for running sums; null when sweep_begins.
  /// May be the same memory as `output`: a cell must be read before it is written.
  const std::byte* previous = nullptr;
  std::byte* state = nullptr;  ///< state_bytes(), 64-byte aligned, kept through the sweep
};

/// Work of a stage for one column of one row, independent of the plan: counted from its kernel, for
/// comparison with the limits of a machine.
struct ColumnWork {
  /// Candidate disparities made or looked at. Lanes that only fill up vectors do not count.
  double cells = 0;
  /// Arithmetic on those cells' numbers: additions, multiplications, divisions, roots, comparisons,
  /// minima and maxima; one that multiplies and adds is two. Not loads, stores, shuffles, masks.
  double operations = 0;
  /// Loaded from and stored to rows of cells and of images, whichever cache they lie in.
  double bytes = 0;
};

/// One step of a chain that turns rows into rows: costs from images, sums from costs, winners from
/// sums. A stage knows its own geometry and nothing of its neighbours, of strips or of threads.
///
/// The first stage of a chain has no input rows (it holds views of the images); the last one has
/// no output rows (bytes_per_column() is 0; it holds views of the results). Both must be told where
/// to read and write at construction.
///
/// What a stage writes for a cell must not depend on how the image was cut: not on the columns
/// asked for, nor on the row where the sweep began (see sweep_start()). That is what makes results
/// bit-identical for all plans and executors.
///
/// Thread rule: make_row() is const and called concurrently with different tasks.
class RowStage {
 public:
  explicit RowStage(Extent extent) : extent_(extent) {}
  RowStage(const RowStage&) = delete;
  RowStage& operator=(const RowStage&) = delete;
  virtual ~RowStage() = default;

  [[nodiscard]] virtual std::string_view name() const = 0;

  /// Size of the grid of cells this stage makes.
  [[nodiscard]] Extent extent() const { return extent_; }

  /// Bytes of one cell column (all its disparities) of an output row, or 0. Rows begin at multiples
  /// of 64 bytes, columns are contiguous.
  [[nodiscard]] virtual std::size_t bytes_per_column() const = 0;

  /// Rows of the input needed to make row y, cut to the input's extent. Both ends must not
  /// decrease with y. Ignored for the first stage.
  [[nodiscard]] virtual Range input_rows(int y, Extent input) const {
    return Range{y, y + 1}.widened(0, input.all_rows());
  }
  /// Columns of the input needed to make `columns`, cut to the input's extent.
  [[nodiscard]] virtual Range input_columns(Range columns, Extent input) const {
    return columns.widened(0, input.all_columns());
  }
  /// Whether strips narrower than the image only repeat work: to make any columns, this stage looks
  /// at all columns of its input, and most of its work is on those. The pass that holds it is not
  /// cut into strips, whatever was asked for.
  [[nodiscard]] virtual bool needs_whole_rows() const { return false; }
  /// Whether this stage looks, beside its input, at row y of the chain's first stage once more, in
  /// the columns it makes. That stage must have the same extent as this one and those between; all
  /// but the first must look at row y of their input to make row y. Executors keep those rows along
  /// the way; where a chain is cut into passes, each pass makes them again, which costs less than
  /// storing and loading them.
  [[nodiscard]] virtual bool reads_source() const { return false; }
  /// Maximum span of input_rows(): the rows kept between this stage and the one before.
  [[nodiscard]] virtual int window_rows() const { return 1; }

  /// Work of the first row of a sweep, in rows: more than 1 for running sums, which start by adding
  /// up a whole window. Only the planner asks.
  [[nodiscard]] virtual int first_row_work() const { return 1; }

  /// Bytes of state that a sweep over `columns` carries from row to row.
  [[nodiscard]] virtual std::size_t state_bytes(Range columns, Extent input) const {
    (void)columns;
    (void)input;
    return 0;
  }
  /// The row ≤ y at which a sweep must begin so that row y comes out the same as in a sweep from
  /// the top of the image. Stages with inexact running sums begin at anchored rows.
  /// Not for a last stage: the rows before its band, which it would write, belong to other tasks.
  [[nodiscard]] virtual int sweep_start(int y) const { return y; }

  /// For profiles. All 0: not known.
  [[nodiscard]] virtual ColumnWork column_work() const { return {}; }

  virtual void make_row(const RowTask& task) const = 0;

 private:
  Extent extent_;
};

}  // namespace vantage::scheduler
