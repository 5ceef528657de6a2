#include "engine/matching/volume/volume_writer.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "engine/matching/levels/level_extents.h"
#include "kernels/cell_winner/cell_winner.h"

namespace vantage {
namespace {

using kernels::FixedEnergy;
using kernels::kLaneMultiple;
using scheduler::Range;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

scheduler::Extent extent_of_level(scheduler::Extent extent, int level) {
  for (int l = 0; l < level; ++l) {
    extent = coarser_extent(extent);
  }
  return extent;
}

VolumeShape shape_of(const VolumeWriter::Space& space) {
  const scheduler::Extent extent =
      extent_of_level({space.geometry.width, space.height_px}, space.level);
  const int steps = space.geometry.steps_per_px;  // the first and the last candidate are whole
  VolumeShape shape{
      .width_px = extent.columns,
      .height_px = extent.rows,
      .disparities = {space.geometry.disparity_min / steps,
                      (space.geometry.disparity_min + space.geometry.count - 1) / steps},
      .steps_per_px = steps,
      .content = space.content};
  if (space.grid) {
    const int min = space.grid->disparity_y_min;
    shape.disparities_y = DisparityRange{min, min + space.grid->rows - 1};
  }
  return shape;
}

/// Runs of lanes of a column: visit(cells, first candidate, candidates).
template <typename Cell, typename Visit>
void for_each_block(const Cell* cells, BlockList blocks, int candidates, const Visit& visit) {
  if (blocks.empty()) {
    visit(cells, 0, candidates);
  }
  for (const std::uint16_t block : blocks) {
    const int first = block * kLaneMultiple;
    visit(cells, first, std::min(kLaneMultiple, candidates - first));
    cells += kLaneMultiple;
  }
}

}  // namespace

FixedEnergyValues::FixedEnergyValues(VolumeContent content, float steps_per_nat)
    : are_probabilities_(content == VolumeContent::kProbabilities),
      of_energy_(std::size_t{kernels::kMaxEnergy} + 1) {
  for (std::size_t energy = 0; energy < of_energy_.size(); ++energy) {
    const double nats = static_cast<double>(energy) / static_cast<double>(steps_per_nat);
    of_energy_[energy] = static_cast<float>(are_probabilities_ ? std::exp(-nats) : nats);
  }
}

VolumeWriter::VolumeWriter(const Space& space, std::vector<VolumeSink*> sinks)
    : space_(space),
      shape_(shape_of(space)),
      candidates_(shape_.candidates()),
      sinks_(std::move(sinks)) {
  // Large enough for efficient writes, small enough for the level-2 cache.
  constexpr int kBlockFloats = 16384;
  block_columns_ = std::max(1, kBlockFloats / candidates_);
}

void VolumeWriter::start() const {
  for (VolumeSink* const sink : sinks_) {
    sink->start(shape_);
  }
}

template <typename Convert>
void VolumeWriter::write_columns(int x, int y, int count, const Convert& convert,
                                 float* work) const {
  for (int done = 0; done < count; done += block_columns_) {
    const int columns = std::min(block_columns_, count - done);
    float* values = work;
    for (int j = done; j < done + columns; ++j, values += candidates_) {
      convert(j, values);
      clear_without_partner(x + j, y, values);
    }
    for (VolumeSink* const sink : sinks_) {
      sink->write(x + done, y, columns, work);
    }
  }
}

void VolumeWriter::write_values(const Columns<float>& columns, float* work) const {
  write_columns(
      columns.x, columns.y, columns.count,
      [&](int column, float* values) {
        std::copy_n(columns.cells + column * columns.pitch, candidates_, values);
      },
      work);
}

void VolumeWriter::write_likelihoods(const Columns<float>& columns, float* work) const {
  write_columns(
      columns.x, columns.y, columns.count,
      [&](int column, float* values) {
        kernels::probability_energy_row(columns.cells + column * columns.pitch, candidates_,
                                        values);
      },
      work);
}

void VolumeWriter::write_fixed_energies(const Columns<FixedEnergy>& columns,
                                        const FixedEnergyValues& of_energies, float* work) const {
  write_columns(
      columns.x, columns.y, columns.count,
      [&](int column, float* values) {
        const FixedEnergy* const cells = columns.cells + column * columns.pitch;
        FixedEnergy min = 0;
        if (of_energies.are_probabilities()) {
          min = kernels::kMaxEnergy;
          for_each_block(cells, columns.blocks, candidates_,
                         [&](const FixedEnergy* of_block, int, int count) {
                           min = std::min(min, *std::min_element(of_block, of_block + count));
                         });
        }
        double sum = 0;
        std::fill_n(values, candidates_, kNaN);
        for_each_block(cells, columns.blocks, candidates_,
                       [&](const FixedEnergy* of_block, int first, int count) {
                         for (int i = 0; i < count; ++i) {
                           const float value =
                               of_energies.of(static_cast<FixedEnergy>(of_block[i] - min));
                           values[first + i] = value;
                           sum += static_cast<double>(value);
                         }
                       });
        if (of_energies.are_probabilities()) {
          const auto scale = static_cast<float>(1 / sum);
          std::transform(values, values + candidates_, values,
                         [scale](float value) { return value * scale; });
        }
      },
      work);
}

void VolumeWriter::write_nothing(int x, int y, int count, float* work) const {
  write_columns(
      x, y, count, [&](int, float* values) { std::fill_n(values, candidates_, kNaN); }, work);
}

/// Rows of displacements for which a pixel of the image that row y of the level covers has a
/// partner.
Range VolumeWriter::rows_with_partner(int y) const {
  const int margin = space_.margin_px;
  const int first = y << space_.level;
  const int last = std::min(((y + 1) << space_.level) - 1, space_.height_px - 1);
  if (last < margin || first >= space_.height_px - margin) {
    return {0, 0};
  }
  if (!space_.grid) {
    return {0, 1};
  }
  const kernels::CandidateRange of_first = space_.grid->rows_with_partner(first, margin);
  const kernels::CandidateRange of_last = space_.grid->rows_with_partner(last, margin);
  return {std::min(of_first.begin, of_last.begin), std::max(of_first.end, of_last.end)};
}

/// The same along rows.
Range VolumeWriter::columns_with_partner(int x) const {
  const int margin = space_.margin_px;
  const int width = space_.geometry.width;
  const int first = x << space_.level;
  const int last = std::min(((x + 1) << space_.level) - 1, width - 1);
  if (last < margin || first >= width - margin) {
    return {0, 0};
  }
  const kernels::CandidateRange of_first = space_.geometry.with_partner(first, margin);
  const kernels::CandidateRange of_last = space_.geometry.with_partner(last, margin);
  return {std::min(of_first.begin, of_last.begin), std::max(of_first.end, of_last.end)};
}

void VolumeWriter::clear_without_partner(int x, int y, float* values) const {
  const Range rows = rows_with_partner(y);
  const Range columns = columns_with_partner(x);
  const int per_row = space_.geometry.count;
  for (int row = 0; row * per_row < candidates_; ++row) {
    float* const of_row = values + row * per_row;
    if (row < rows.begin || row >= rows.end || columns.begin >= columns.end) {
      std::fill_n(of_row, per_row, kNaN);
      continue;
    }
    std::fill(of_row, of_row + columns.begin, kNaN);
    std::fill(of_row + columns.end, of_row + per_row, kNaN);
  }
}

const VolumeWriter* find_writer(const std::vector<VolumeWriter>& writers, VolumeKind kind,
                                int level) {
  const auto found = std::ranges::find_if(writers, [&](const VolumeWriter& writer) {
    return writer.kind() == kind && writer.level() == level;
  });
  return found == writers.end() ? nullptr : &*found;
}

}  // namespace vantage
