#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "engine/image/volume_sink.h"
#include "engine/matching/costs/displacement_grid.h"
#include "engine/matching/levels/candidate_blocks.h"
#include "engine/matching/volume/volume_request.h"
#include "kernels/candidates.h"
#include "kernels/cells/fixed_energy.h"
#include "scheduler/range.h"

namespace vantage {

/// Values of fixed-point energies: of nats, or exp(−nats) before they are normalised. Identical on
/// every instruction set.
class FixedEnergyValues {
 public:
  FixedEnergyValues(VolumeContent content, float steps_per_nat);

  [[nodiscard]] bool are_probabilities() const { return are_probabilities_; }
  /// energy ≥ 0
  [[nodiscard]] float of(kernels::FixedEnergy energy) const {
    return of_energy_[static_cast<std::size_t>(energy)];
  }

 private:
  bool are_probabilities_;
  std::vector<float> of_energy_;
};

/// Hands the cells of one level to sinks: NaN for candidates without a partner, padding left out.
/// Thread rule: functions are const and may be called concurrently for different pixels.
class VolumeWriter {
 public:
  /// The disparity space that cells belong to.
  struct Space {
    kernels::CandidateGeometry geometry;   ///< of the image along rows
    std::optional<DisplacementGrid> grid;  ///< of the image
    int height_px = 0;                     ///< of the image
    int level = 0;
    /// Pixels and partners count if they lie at least this far inside their images.
    int margin_px = 0;
    VolumeKind kind = VolumeKind::kAggregated;
    VolumeContent content = VolumeContent::kEnergies;
  };
  /// Consecutive columns of a row of cells.
  template <typename Cell>
  struct Columns {
    const Cell* cells = nullptr;
    std::ptrdiff_t pitch = 0;  ///< cells between columns
    int x = 0;
    int y = 0;
    int count = 0;
    BlockList blocks = {};  ///< whose lanes the cells occupy; empty: all candidates
  };

  VolumeWriter(const Space& space, std::vector<VolumeSink*> sinks);

  [[nodiscard]] VolumeKind kind() const { return space_.kind; }
  [[nodiscard]] int level() const { return space_.level; }
  [[nodiscard]] const VolumeShape& shape() const { return shape_; }
  /// Calls start() of all sinks.
  void start() const;

  /// Working memory of the functions below, in floats.
  [[nodiscard]] std::size_t work_floats() const {
    return static_cast<std::size_t>(block_columns_) * static_cast<std::size_t>(candidates_);
  }
  /// Cells that are the values.
  void write_values(const Columns<float>& columns, float* work) const;
  /// Values −ln p of likelihoods.
  void write_likelihoods(const Columns<float>& columns, float* work) const;
  /// Energies in nats, or probabilities that sum to 1 over the candidates of the column's blocks.
  void write_fixed_energies(const Columns<kernels::FixedEnergy>& columns,
                            const FixedEnergyValues& values, float* work) const;
  /// Columns without any candidate.
  void write_nothing(int x, int y, int count, float* work) const;

 private:
  /// `convert(j, values)` fills the values of column j, with or without a partner.
  template <typename Convert>
  void write_columns(int x, int y, int count, const Convert& convert, float* work) const;
  void clear_without_partner(int x, int y, float* values) const;
  [[nodiscard]] scheduler::Range rows_with_partner(int y) const;
  [[nodiscard]] scheduler::Range columns_with_partner(int x) const;

  Space space_;
  VolumeShape shape_;
  int candidates_;
  int block_columns_;
  std::vector<VolumeSink*> sinks_;
};

/// The writer of these cells, or null.
const VolumeWriter* find_writer(const std::vector<VolumeWriter>& writers, VolumeKind kind,
                                int level);

}  // namespace vantage
