#pragma once

#include <cstddef>
#include <cstdint>

#include "engine/image/image.h"
#include "engine/matching/levels/candidate_blocks.h"
#include "engine/matching/levels/level_volume.h"
#include "kernels/candidate_windows.h"
#include "kernels/candidates.h"
#include "scheduler/range.h"

namespace vantage {

/// What a level knows of its pixels' disparities, read by the next finer level of windows. Thread
/// rule: immutable.
class CoarseBeliefs {
 public:
  CoarseBeliefs() = default;
  CoarseBeliefs(const CoarseBeliefs&) = delete;
  CoarseBeliefs& operator=(const CoarseBeliefs&) = delete;
  virtual ~CoarseBeliefs() = default;

  [[nodiscard]] virtual scheduler::Extent extent() const = 0;
  /// Disparity of the level's candidate 0, in its own pixels.
  [[nodiscard]] virtual int disparity_min() const = 0;
  /// Nats per step of the bytes of energies_row().
  [[nodiscard]] virtual double nats_per_step() const = 0;
  /// The candidates with the lowest energy of row y.
  virtual void winners_row(int y, std::int16_t* winners) const = 0;
  /// Byte i of energies[x]: the energy of candidate first[x] + i of column x in row y, above the
  /// least of the column, for x in `columns`; 255 where it was not searched. valid: bytes that
  /// count, 6 or 8. Columns with first[x] below 0 are left out.
  virtual void energies_row(int y, scheduler::Range columns, const std::int16_t* first, int valid,
                            kernels::WindowCells* energies) const = 0;
};

/// The result of a coarse level of all candidates, or of blocks of them. References must outlive
/// the object.
class LevelBeliefs final : public CoarseBeliefs {
 public:
  /// energies: bytes of the method's EnergyFormat::of_result(). blocks: null: all candidates.
  /// geometry: of the level's candidates.
  LevelBeliefs(const LevelVolume& energies, const CandidateBlocks* blocks,
               ImageView<const std::int32_t> winners, const kernels::CandidateGeometry& geometry,
               double nats_per_step);

  [[nodiscard]] scheduler::Extent extent() const override { return energies_.extent(); }
  [[nodiscard]] int disparity_min() const override { return disparity_min_; }
  [[nodiscard]] double nats_per_step() const override { return nats_per_step_; }
  void winners_row(int y, std::int16_t* winners) const override;
  void energies_row(int y, scheduler::Range columns, const std::int16_t* first, int valid,
                    kernels::WindowCells* energies) const override;

 private:
  template <int kValid>
  void fetch_row(int y, scheduler::Range columns, const std::int16_t* first,
                 kernels::WindowCells* energies) const;

  const LevelVolume& energies_;
  const CandidateBlocks* blocks_;
  ImageView<const std::int32_t> winners_;
  int disparity_min_;
  int blocks_count_;  ///< of all candidates
  double nats_per_step_;
};

/// The result of a level of windows: of each pixel the window that holds its winner.
struct WindowState {
  Image<kernels::WindowCells> support;
  Image<std::int16_t> start;   ///< first candidates of the windows
  Image<std::int16_t> winner;  ///< candidates
  int disparity_min = 0;
  int ceiling = 0;  ///< largest cell
  double nats_per_step = 0;

  void resize(scheduler::Extent extent) {
    support.resize(extent.columns, extent.rows);
    start.resize(extent.columns, extent.rows);
    winner.resize(extent.columns, extent.rows);
  }
  [[nodiscard]] std::size_t held_bytes() const;
};

/// `state` must outlive the object.
class WindowBeliefs final : public CoarseBeliefs {
 public:
  explicit WindowBeliefs(const WindowState& state) : state_(state) {}

  [[nodiscard]] scheduler::Extent extent() const override {
    return {state_.winner.width(), state_.winner.height()};
  }
  [[nodiscard]] int disparity_min() const override { return state_.disparity_min; }
  [[nodiscard]] double nats_per_step() const override { return state_.nats_per_step; }
  void winners_row(int y, std::int16_t* winners) const override;
  void energies_row(int y, scheduler::Range columns, const std::int16_t* first, int valid,
                    kernels::WindowCells* energies) const override;

 private:
  const WindowState& state_;
};

}  // namespace vantage
