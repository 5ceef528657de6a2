#include "kernels/simd-inl.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

#include "kernels/candidates.h"
#include "kernels/cells/energy_vectors-inl.h"
#include "kernels/cells/star_columns-inl.h"
#include "kernels/max_product_step/max_product_step.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {

using EnergyColumns = StarColumns<FixedEnergy>;

// Energies E0.
class SourceEnergies {
 public:
  SourceEnergies(const MaxProductRow& /*row*/, const EnergyColumns& at) : source_(at.source) {}
  [[nodiscard]] HWY_INLINE EnergyVec of(int lane) const {
    return hn::Load(EnergyTag(), source_ + lane);
  }

 private:
  const FixedEnergy* source_;
};

// E0 plus the weighted sum over the star.
template <bool kWeighted>
class StarEnergies {
 public:
  StarEnergies(const MaxProductRow& row, const EnergyColumns& at)
      : at_(at),
        mu_(hn::Set(EnergyTag(), row.mu)),
        left_(kWeighted ? hn::Set(EnergyTag(), row.weights.beside[at.x]) : mu_),
        right_(kWeighted ? hn::Set(EnergyTag(), row.weights.beside[at.x + 1]) : mu_),
        up_(kWeighted ? hn::Set(EnergyTag(), row.weights.above[at.x]) : mu_),
        down_(kWeighted ? hn::Set(EnergyTag(), row.weights.below[at.x]) : mu_) {}

  [[nodiscard]] HWY_INLINE EnergyVec of(int lane) const {
    const EnergyTag d;
    const auto part = [lane](const FixedEnergy* cells, EnergyVec weight) HWY_ATTR {
      return hn::MulFixedPoint15(hn::Load(EnergyTag(), cells + lane), weight);
    };
    const EnergyVec vertical = hn::Add(part(at_.up, up_), part(at_.down, down_));
    const EnergyVec horizontal = hn::Add(part(at_.left, left_), part(at_.right, right_));
    const EnergyVec star = hn::Add(hn::Add(vertical, horizontal), part(at_.centre, mu_));
    return hn::SaturatedAdd(star, hn::Load(d, at_.source + lane));
  }

 private:
  EnergyColumns at_;
  EnergyVec mu_;
  EnergyVec left_;
  EnergyVec right_;
  EnergyVec up_;
  EnergyVec down_;
};

// Minimum of the energies kOffset lanes before and after those of a vector, from the adjacent
// vectors.
template <int kOffset>
HWY_INLINE EnergyVec min_beside(EnergyVec before, EnergyVec here, EnergyVec after) {
  const EnergyTag d;
  if constexpr (kEnergyLanes > 8) {
    // Byte shifts work within 16-byte blocks: first fetches the adjacent block.
    before = hn::ConcatLowerUpper(d, here, before);
    after = hn::ConcatLowerUpper(d, after, here);
  }
  constexpr int kBytes = kOffset * static_cast<int>(sizeof(FixedEnergy));
  return hn::Min(hn::CombineShiftRightBytes<16 - kBytes>(d, here, before),
                 hn::CombineShiftRightBytes<kBytes>(d, after, here));
}

constexpr int kBlockVectors = kLaneMultiple / kEnergyLanes;

// Results of columns of kBlocks blocks, entirely in registers: takes three quarters of the time in
// memory. kRadius: radius of the prior, 1 or 2; 0: no smoothing. kBroken: there are segments.
template <class Energies, int kBlocks, int kRadius, bool kBroken>
HWY_INLINE void run_in_registers(const MaxProductRow& given) {
  constexpr int kVectors = kBlocks * kBlockVectors;
  const EnergyTag d;
  const MaxProductRow row = given;  // a copy: stores cannot alias it
  const EnergyVec max = hn::Set(d, kMaxEnergy);
  const EnergyVec ceiling = hn::Set(d, row.prior.ceiling);
  const EnergyVec first_rise = kRadius >= 1 ? hn::Set(d, row.prior.rises[0]) : ceiling;
  const EnergyVec second_rise = kRadius >= 2 ? hn::Set(d, row.prior.rises[1]) : ceiling;
  // kMaxEnergy where a segment starts at the block, which hides the energies across its start.
  EnergyVec hidden[kBlocks];
  for (int block = 0; kBroken && block < kBlocks; ++block) {
    const bool starts = std::find(row.segment_ends.begin(), row.segment_ends.end(),
                                  block * kLaneMultiple) != row.segment_ends.end();
    hidden[block] = starts ? max : hn::Zero(d);
  }
  const auto column = [&](const EnergyColumns& at, FixedEnergy* output) HWY_ATTR
      __attribute__((always_inline)) {
    const Energies of_lanes(row, at);
    EnergyVec energies[kVectors];
    EnergyVec min = max;
#pragma GCC unroll 16
    for (int v = 0; v < kVectors; ++v) {
      energies[v] = of_lanes.of(v * kEnergyLanes);
      min = hn::Min(min, energies[v]);
    }
    min = min_of_lanes(min);
#pragma GCC unroll 16
    for (int v = 0; v < kVectors; ++v) {
      const EnergyVec here = energies[v];
      if constexpr (kRadius == 0) {
        hn::Store(hn::Sub(here, min), d, output + v * kEnergyLanes);
      } else {
        EnergyVec before = v > 0 ? energies[v - 1] : max;
        EnergyVec after = v + 1 < kVectors ? energies[v + 1] : max;
        if (kBroken && v > 0 && v % kBlockVectors == 0) {
          before = hn::Max(before, hidden[v / kBlockVectors]);
        }
        if (kBroken && v + 1 < kVectors && (v + 1) % kBlockVectors == 0) {
          after = hn::Max(after, hidden[(v + 1) / kBlockVectors]);
        }
        EnergyVec smoothed =
            hn::Min(here, hn::SaturatedAdd(min_beside<1>(before, here, after), first_rise));
        if constexpr (kRadius >= 2) {
          smoothed =
              hn::Min(smoothed, hn::SaturatedAdd(min_beside<2>(before, here, after), second_rise));
        }
        // Saturated sums do not matter: the lane's own energy is not above them.
        hn::Store(hn::Min(hn::Sub(smoothed, min), ceiling), d, output + v * kEnergyLanes);
      }
    }
  };
  each_column(row, column);
}

// Energies of a few columns in memory, with unreachable cells on both sides of each segment of
// lanes. First all are computed, then all are smoothed. One by one, each column would wait for the
// minimum over its lanes and for loads that straddle two stored vectors.
class EnergyWork {
 public:
  explicit EnergyWork(const MaxProductRow& row)
      : row_(row),
        columns_(max_product_work_columns(row.star.lanes)),
        margin_(max_product_work_margin(row.prior.radius)),
        segment_ends_(row.segment_ends.empty() ? std::span<const int>(&row.star.lanes, 1)
                                               : row.segment_ends),
        pitch_(row.star.lanes + (static_cast<int>(segment_ends_.size()) + 1) * margin_) {
    for (int j = 0; j < std::min(columns_, row.star.columns); ++j) {
      clear_margin(energies(j) - margin_);
      FixedEnergy* after = energies(j);
      for (const int end : segment_ends_) {
        clear_margin(after + end);
        after += margin_;
      }
    }
  }

  template <class Energies>
  HWY_INLINE void run() const {
    EnergyVec min[kMaxColumns];
    FixedEnergy* block_output = row_.output;
    int filled = 0;
    const auto column = [&](const EnergyColumns& at, FixedEnergy* /*output*/) HWY_ATTR
        __attribute__((always_inline)) {
      min[filled] = make(Energies(row_, at), energies(filled));
      ++filled;
      if (filled == columns_ || at.x + 1 == row_.star.columns) {
        finish(min, filled, block_output);
        block_output += filled * row_.output_pitch;
        filled = 0;
      }
    };
    each_column(row_, column);
  }

 private:
  static constexpr int kMaxColumns = 16;  // maximum of max_product_work_columns()

  void clear_margin(FixedEnergy* margin) const {
    for (int lane = 0; lane < margin_; lane += kEnergyLanes) {
      hn::Store(hn::Set(EnergyTag(), kMaxEnergy), EnergyTag(), margin + lane);
    }
  }
  [[nodiscard]] FixedEnergy* energies(int column) const {
    return row_.work + column * pitch_ + margin_;
  }

  // Returns the column's minimum, in every lane.
  template <class Energies>
  HWY_INLINE EnergyVec make(const Energies& of_lanes, FixedEnergy* energies) const {
    const EnergyTag d;
    EnergyVec min = hn::Set(d, kMaxEnergy);
    int lane = 0;
    for (const int end : segment_ends_) {
#pragma GCC unroll 4
      for (; lane < end; lane += kEnergyLanes) {
        const EnergyVec value = of_lanes.of(lane);
        hn::Store(value, d, energies + lane);
        min = hn::Min(min, value);
      }
      energies += margin_;
    }
    return min_of_lanes(min);
  }

  // Stores the row's kind of result for the first `columns` columns in work memory.
  HWY_NOINLINE void finish(const EnergyVec* min, int columns, FixedEnergy* output) const {
    if (!row_.smooths) {
      return finish_columns<false, 0>(min, columns, output);
    }
    if (row_.plane.is_given()) {
      for (int j = 0; j < columns; ++j) {
        finish_plane(energies(j), min[j], output + j * row_.output_pitch);
      }
      return;
    }
    switch (row_.prior.radius) {
      case 1:
        return finish_columns<true, 1>(min, columns, output);
      case 2:
        return finish_columns<true, 2>(min, columns, output);
      default:
        return finish_columns<true, -1>(min, columns, output);
    }
  }

  // kRadius: radius of the prior; −1 for any.
  template <bool kSmooths, int kRadius>
  HWY_INLINE void finish_columns(const EnergyVec* min, int columns, FixedEnergy* output) const {
    const EnergyTag d;
    const MaxProductRow row = row_;  // a copy: stores cannot alias it
    const int radius = kRadius >= 0 ? kRadius : row.prior.radius;
    const EnergyVec ceiling = hn::Set(d, row.prior.ceiling);
    const EnergyVec first_rise = radius >= 1 ? hn::Set(d, row.prior.rises[0]) : ceiling;
    for (int j = 0; j < columns; ++j, output += row.output_pitch) {
      const FixedEnergy* column = energies(j);
      int lane = 0;
      for (const int end : segment_ends_) {
#pragma GCC unroll 4
        for (; lane < end; lane += kEnergyLanes) {
          const FixedEnergy* const at = column + lane;
          EnergyVec result = hn::Load(d, at);
          for (int k = 1; k <= radius; ++k) {
            const EnergyVec beside = hn::Min(hn::LoadU(d, at - k), hn::LoadU(d, at + k));
            const EnergyVec rise = k == 1 ? first_rise : hn::Set(d, row.prior.rises[k - 1]);
            result = hn::Min(result, hn::SaturatedAdd(beside, rise));
          }
          result = hn::Sub(result, min[j]);
          hn::Store(kSmooths ? hn::Min(result, ceiling) : result, d, output + lane);
        }
        column += margin_;
      }
    }
  }

  // ES of a column of a two-dimensional search: the minimum horizontally, then vertically.
  HWY_INLINE void finish_plane(const FixedEnergy* energies, EnergyVec min,
                               FixedEnergy* output) const {
    const EnergyTag d;
    const CandidatePlane& plane = row_.plane;
    const FixedEnergy* const rises = row_.prior.rises;
    const int row_lanes = plane.row_lanes();
    const int spread_pitch = row_lanes + margin_;
    FixedEnergy* const spread = row_.work + columns_ * pitch_ + margin_;
    FixedEnergy* const across = spread + plane.rows * spread_pitch;
    FixedEnergy* const smoothed = across + plane.rows * row_lanes;
    std::fill(spread - margin_, across, kMaxEnergy);
    for (int r = 0; r < plane.rows; ++r) {
      std::copy_n(energies + r * plane.row_candidates, plane.row_candidates,
                  spread + r * spread_pitch);
      for (int lane = 0; lane < row_lanes; lane += kEnergyLanes) {
        const FixedEnergy* const at = spread + r * spread_pitch + lane;
        EnergyVec result = hn::LoadU(d, at);
        for (int k = 1; k <= row_.prior.radius; ++k) {
          const EnergyVec beside = hn::Min(hn::LoadU(d, at - k), hn::LoadU(d, at + k));
          result = hn::Min(result, hn::SaturatedAdd(beside, hn::Set(d, rises[k - 1])));
        }
        hn::StoreU(result, d, across + r * row_lanes + lane);
      }
    }
    const EnergyVec ceiling = hn::Set(d, row_.prior.ceiling);
    for (int r = 0; r < plane.rows; ++r) {
      for (int lane = 0; lane < row_lanes; lane += kEnergyLanes) {
        EnergyVec result = hn::LoadU(d, across + r * row_lanes + lane);
        for (int k = 1; k <= row_.prior.radius; ++k) {
          const EnergyVec rise = hn::Set(d, rises[k - 1]);
          for (const int beside : {r - k, r + k}) {
            if (beside >= 0 && beside < plane.rows) {
              const EnergyVec there = hn::LoadU(d, across + beside * row_lanes + lane);
              result = hn::Min(result, hn::SaturatedAdd(there, rise));
            }
          }
        }
        // Values stored after a run's candidates are overwritten by the next run.
        hn::StoreU(hn::Min(hn::Sub(result, min), ceiling), d,
                   smoothed + r * plane.row_candidates + lane);
      }
    }
    std::fill(smoothed + plane.count(), smoothed + row_.star.lanes, row_.prior.ceiling);
    std::copy_n(smoothed, row_.star.lanes, output);
  }

  const MaxProductRow& row_;
  int columns_;
  int margin_;
  std::span<const int> segment_ends_;
  int pitch_;
};

// Returns false for columns that are too long.
template <class Energies, int kRadius>
HWY_INLINE bool run_if_short(const MaxProductRow& row) {
  if (kRadius > 0 && row.segment_ends.size() > 1) {
    switch (row.star.lanes / kLaneMultiple) {
      case 2:
        run_in_registers<Energies, 2, kRadius, true>(row);
        return true;
      case 3:
        run_in_registers<Energies, 3, kRadius, true>(row);
        return true;
      default:
        return false;
    }
  }
  switch (row.star.lanes / kLaneMultiple) {
    case 1:
      run_in_registers<Energies, 1, kRadius, false>(row);
      return true;
    case 2:
      run_in_registers<Energies, 2, kRadius, false>(row);
      return true;
    case 3:
      run_in_registers<Energies, 3, kRadius, false>(row);
      return true;
    case 4:
      run_in_registers<Energies, 4, kRadius, false>(row);
      return true;
    case 5:
      run_in_registers<Energies, 5, kRadius, false>(row);
      return true;
    case 6:
      run_in_registers<Energies, 6, kRadius, false>(row);
      return true;
    case 8:
      run_in_registers<Energies, 8, kRadius, false>(row);
      return true;
    default:
      return false;
  }
}

template <class Energies>
HWY_INLINE void run_columns(const MaxProductRow& row) {
  const bool is_short = !row.smooths            ? run_if_short<Energies, 0>(row)
                        : row.plane.is_given()  ? false
                        : row.prior.radius == 1 ? run_if_short<Energies, 1>(row)
                        : row.prior.radius == 2 ? run_if_short<Energies, 2>(row)
                                                : false;
  if (!is_short) {
    EnergyWork(row).run<Energies>();
  }
}

void start(const MaxProductRow& row) { run_columns<SourceEnergies>(row); }

void step(const MaxProductRow& row) {
  if (row.weights.are_given()) {
    run_columns<StarEnergies<true> >(row);
  } else {
    run_columns<StarEnergies<false> >(row);
  }
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vantage::kernels {
HWY_EXPORT(start);
HWY_EXPORT(step);

void max_product_start_row(const MaxProductRow& row) { HWY_DYNAMIC_DISPATCH(start)(row); }
void max_product_row(const MaxProductRow& row) { HWY_DYNAMIC_DISPATCH(step)(row); }

}  // namespace vantage::kernels
#endif
