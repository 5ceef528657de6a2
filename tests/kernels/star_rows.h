#pragma once

#include "engine/image/image.h"
#include "kernels/candidates.h"
#include "kernels/star_row.h"
#include "tests/kernels/kernel_test_utils.h"

namespace vantage::kernels {

/// Three rows of random cells with a column beyond either end, and a source row, for tests of
/// iterations: aligned as kernels expect them. Whole numbers are what is left of floats in
/// [low, high).
template <typename Cell>
class CellStarRows {
 public:
  CellStarRows(int columns, int lanes, int pitch, float low, float high, unsigned seed)
      : cells_(pitch * (columns + 2), 3), source_(lanes * columns, 1), neutral_(lanes, 1) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> value(low, high);
    const auto cell = [&] { return static_cast<Cell>(value(random)); };
    for (int y = 0; y < 3; ++y) {
      std::generate_n(cells_.row(y), cells_.width(), cell);
    }
    std::generate_n(source_.row(0), source_.width(), cell);
    star_.columns = columns;
    star_.lanes = lanes;
    star_.pitch = star_.up_pitch = star_.down_pitch = pitch;
    star_.centre = cells_.row(1) + pitch;
    star_.up = cells_.row(0) + pitch;
    star_.down = cells_.row(2) + pitch;
    star_.left_of_first = star_.centre - pitch;
    star_.right_of_last = star_.centre + static_cast<std::ptrdiff_t>(columns) * pitch;
    star_.source = source_.row(0);
  }

  [[nodiscard]] const CellStarRow<Cell>& star() const { return star_; }
  [[nodiscard]] Cell* source() { return source_.row(0); }
  [[nodiscard]] Cell* centre(int column) { return cells_.row(1) + star_.pitch * (column + 1); }

  /// The row above is missing: a column of `neutral` stands for it.
  void remove_up(Cell neutral) {
    neutral_.fill(neutral);
    star_.up = neutral_.row(0);
    star_.up_pitch = 0;
  }

 private:
  Image<Cell> cells_;
  Image<Cell> source_;
  Image<Cell> neutral_;
  CellStarRow<Cell> star_;
};

using StarRows = CellStarRows<float>;

/// Random weights of the neighbours of a row's columns.
class RandomStarWeights {
 public:
  RandomStarWeights(int columns, unsigned seed)
      : beside_(static_cast<std::size_t>(columns) + 1), above_(beside_), below_(beside_) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> value(0, 1);
    for (std::vector<float>* const weights : {&beside_, &above_, &below_}) {
      std::generate(weights->begin(), weights->end(), [&] { return value(random); });
    }
  }

  [[nodiscard]] StarWeights star() const { return {beside_.data(), above_.data(), below_.data()}; }

 private:
  std::vector<float> beside_;
  std::vector<float> above_;
  std::vector<float> below_;
};

/// `count` candidates as displacements in two dimensions, in runs as `choice` says; not given where
/// they cannot be.
inline CandidatePlane plane_of(int count, unsigned choice) {
  std::vector<CandidatePlane> planes;
  for (int in_row = 2; 2 * in_row <= count; ++in_row) {
    if (count % in_row == 0) {
      planes.push_back({in_row, count / in_row});
    }
  }
  return planes.empty() ? CandidatePlane{} : planes[choice % planes.size()];
}

}  // namespace vantage::kernels
