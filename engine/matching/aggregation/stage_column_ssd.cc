#include "engine/matching/aggregation/stage_column_ssd.h"

#include <algorithm>
#include <cstring>

#include "engine/column_work.h"
#include "engine/matching/costs/cells_without_partner.h"
#include "kernels/column_ssd/column_ssd.h"

namespace vantage {
namespace {

using kernels::CandidateGeometry;
using scheduler::Extent;
using scheduler::Range;

/// Common part of both depths; `Pixel` is uint8_t or float.
template <typename Pixel>
class ColumnSsdStage : public scheduler::RowStage {
 public:
  ColumnSsdStage(const IntensityPlane<Pixel>& reference, const IntensityPlane<Pixel>& partner,
                 const CandidateGeometry& geometry, int height, int radius)
      : RowStage({geometry.width, height}),
        reference_(reference),
        partner_(partner),
        geometry_(geometry),
        lanes_(geometry.lanes()),
        radius_(radius) {}

  [[nodiscard]] std::string_view name() const override { return "column SSD"; }
  [[nodiscard]] std::size_t bytes_per_column() const override {
    return sizeof(std::int32_t) * static_cast<std::size_t>(lanes_);
  }
  [[nodiscard]] int first_row_work() const override {
    return std::min(2 * radius_ + 1, extent().rows);
  }

  void make_row(const scheduler::RowTask& task) const override {
    auto* sums = reinterpret_cast<std::int32_t*>(task.output);
    const auto* previous = reinterpret_cast<const std::int32_t*>(task.previous);
    const int enters = task.y + radius_;
    if (task.sweep_begins) {
      std::memset(sums, 0, bytes_per_column() * static_cast<std::size_t>(task.columns.size()));
      for (int y = std::max(0, task.y - radius_); y <= std::min(enters, extent().rows - 1); ++y) {
        add_rows(task, y, kNoRow, sums, sums);
      }
    } else {
      const int leaves = task.y - radius_ - 1;
      add_rows(task, enters < extent().rows ? enters : kNoRow, leaves >= 0 ? leaves : kNoRow,
               previous, sums);
    }
    clear_without_partner(geometry_, radius_, task.columns, geometry_.lanes(), sums);
  }

 protected:
  static constexpr int kNoRow = -1;

  /// sums = previous + squares of row `enters` − squares of row `leaves`; either may be kNoRow.
  virtual void add_rows(const scheduler::RowTask& task, int enters, int leaves,
                        const std::int32_t* previous, std::int32_t* sums) const = 0;

  [[nodiscard]] bool mirrored() const { return geometry_.direction < 0; }
  [[nodiscard]] int partner_step() const { return mirrored() ? -1 : 1; }
  /// Position in a row of the partner plane of the partner of candidate 0 of column x.
  [[nodiscard]] int partner_offset(int x) const {
    return (mirrored() ? geometry_.width - 1 - x : x) + geometry_.disparity_min;
  }
  [[nodiscard]] const Pixel* reference_row(int y, int x) const {
    return y == kNoRow ? nullptr : reference_.row(y) + x;
  }
  [[nodiscard]] const Pixel* partner_row(int y, int x) const {
    return y == kNoRow ? nullptr : partner_.row(y) + partner_offset(x);
  }
  [[nodiscard]] int lanes() const { return lanes_; }
  [[nodiscard]] int count() const { return geometry_.count; }

 private:
  const IntensityPlane<Pixel>& reference_;
  const IntensityPlane<Pixel>& partner_;
  CandidateGeometry geometry_;
  int lanes_;
  int radius_;
};

class ColumnSsdStage8Bit final : public ColumnSsdStage<std::uint8_t> {
 public:
  ColumnSsdStage8Bit(const IntensityPlane<std::uint8_t>& reference,
                     const IntensityPlane<std::uint8_t>& partner, const CandidateGeometry& geometry,
                     int height, int radius, int shift)
      : ColumnSsdStage(reference, partner, geometry, height, radius), shift_(shift) {}

  [[nodiscard]] std::size_t state_bytes(Range columns, Extent /*input*/) const override {
    return sizeof(std::int32_t) * (pair_room(columns.size()) + pair_room(columns.size() + lanes()));
  }
  [[nodiscard]] scheduler::ColumnWork column_work() const override {
    return vantage::column_work(kernels::kColumnSsdPairsWork, count());
  }

 private:
  static std::size_t pair_room(int pairs) {
    return static_cast<std::size_t>(pairs) + kernels::kLaneMultiple;
  }

  void add_rows(const scheduler::RowTask& task, int enters, int leaves,
                const std::int32_t* previous, std::int32_t* sums) const override {
    const Range columns = task.columns;
    auto* reference = reinterpret_cast<std::int32_t*>(task.state);
    std::int32_t* partner = reference + pair_room(columns.size());
    kernels::interleave_rows(reference_row(enters, columns.begin),
                             reference_row(leaves, columns.begin), shift_, columns.size(),
                             reference);
    // Partners of all columns and candidates, in the order of the plane.
    const int lowest_column = mirrored() ? columns.end - 1 : columns.begin;
    kernels::interleave_rows(partner_row(enters, lowest_column), partner_row(leaves, lowest_column),
                             shift_, columns.size() + lanes(), partner);
    kernels::ColumnSsdPairs row;
    row.reference = reference;
    row.partner = partner + (mirrored() ? columns.size() - 1 : 0);
    row.partner_step = partner_step();
    row.columns = columns.size();
    row.lanes = lanes();
    kernels::column_ssd_row(row, previous, sums);
  }

  int shift_;
};

class ColumnSsdStageFloat final : public ColumnSsdStage<float> {
 public:
  using ColumnSsdStage::ColumnSsdStage;

  [[nodiscard]] scheduler::ColumnWork column_work() const override {
    return vantage::column_work(kernels::kColumnSsdFloatWork, count());
  }

 private:
  void add_rows(const scheduler::RowTask& task, int enters, int leaves,
                const std::int32_t* previous, std::int32_t* sums) const override {
    kernels::ColumnSsdFloat row;
    row.reference_entering = reference_row(enters, task.columns.begin);
    row.reference_leaving = reference_row(leaves, task.columns.begin);
    row.partner_entering = partner_row(enters, task.columns.begin);
    row.partner_leaving = partner_row(leaves, task.columns.begin);
    row.partner_step = partner_step();
    row.columns = task.columns.size();
    row.lanes = lanes();
    kernels::column_ssd_row(row, previous, sums);
  }
};

}  // namespace

std::unique_ptr<scheduler::RowStage> make_column_ssd_stage(
    const IntensityPlane<std::uint8_t>& reference, const IntensityPlane<std::uint8_t>& partner,
    const CandidateGeometry& geometry, int height, int radius, int shift) {
  return std::make_unique<ColumnSsdStage8Bit>(reference, partner, geometry, height, radius, shift);
}

std::unique_ptr<scheduler::RowStage> make_column_ssd_stage(const IntensityPlane<float>& reference,
                                                           const IntensityPlane<float>& partner,
                                                           const CandidateGeometry& geometry,
                                                           int height, int radius) {
  return std::make_unique<ColumnSsdStageFloat>(reference, partner, geometry, height, radius);
}

}  // namespace vantage
