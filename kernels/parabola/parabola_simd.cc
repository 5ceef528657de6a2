#include "kernels/simd-inl.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "kernels/cell_winner/logarithm-inl.h"
#include "kernels/parabola/parabola.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {

using Tag64 = hn::ScalableTag<double>;
using Tag32 = hn::Rebind<std::int32_t, Tag64>;
using TagF = hn::Rebind<float, Tag64>;
using Vec64 = hn::VFromD<Tag64>;

// Columns whose three cells are gathered at a time; a multiple of every vector length. Large enough
// that the first values have reached the cache before they are loaded as vectors.
constexpr int kBlock = 32;

// Cells of winners and their neighbours, column by column. If a winner lacks a neighbour, the
// values are arbitrary.
template <typename Cell>
struct Triples {
  HWY_ALIGN Cell below[kBlock];
  HWY_ALIGN Cell at[kBlock];
  HWY_ALIGN Cell above[kBlock];

  // cells: a column of at least three lanes; the winner must not be the last lane.
  HWY_INLINE void gather(int j, const Cell* cells, std::int32_t winner) {
    const Cell* cell = cells + std::max(winner, 1);
    below[j] = cell[-1];
    at[j] = cell[0];
    above[j] = cell[1];
  }
};

// Window sums, comparable directly where all windows are whole.
struct SumEnergy {
  int index_bits;
  HWY_INLINE Vec64 operator()(const std::int32_t* cells) const {
    return hn::PromoteTo(Tag64(), hn::ShiftRightSame(hn::Load(Tag32(), cells), index_bits));
  }
};
struct CellEnergy {
  HWY_INLINE Vec64 operator()(const float* cells) const {
    return hn::PromoteTo(Tag64(), hn::Load(TagF(), cells));
  }
};
/// Infinite where the probability is 0.
struct ProbabilityEnergy {
  HWY_INLINE Vec64 operator()(const float* cells) const {
    const Tag64 d64;
    const Vec64 p = hn::PromoteTo(d64, hn::Load(TagF(), cells));
    const Vec64 energy = hn::Sub(hn::Zero(d64), natural_logarithm(d64, p));
    return hn::IfThenElse(hn::Gt(p, hn::Zero(d64)), energy,
                          hn::Set(d64, std::numeric_limits<double>::infinity()));
  }
};

// Candidate range that is the same for all columns.
struct SameCandidates {
  CandidateRange range;
  [[nodiscard]] HWY_INLINE Vec64 first(int /*j*/) const { return hn::Set(Tag64(), range.begin); }
  [[nodiscard]] HWY_INLINE Vec64 last(int /*j*/) const { return hn::Set(Tag64(), range.end - 1); }
};
// Candidate range of each column of a block.
struct OwnCandidates {
  HWY_ALIGN double firsts[kBlock] = {};
  HWY_ALIGN double lasts[kBlock] = {};
  [[nodiscard]] HWY_INLINE Vec64 first(int j) const { return hn::Load(Tag64(), firsts + j); }
  [[nodiscard]] HWY_INLINE Vec64 last(int j) const { return hn::Load(Tag64(), lasts + j); }
};

template <typename Cell, class Energy, class Candidates>
HWY_INLINE Vec64 refined(const Triples<Cell>& triples, Energy energy, const Candidates& candidates,
                         int j, Vec64 winner, int disparity_min) {
  const Tag64 d64;
  const Vec64 infinity = hn::Set(d64, std::numeric_limits<double>::infinity());
  const Vec64 below = energy(triples.below + j);
  const Vec64 at = energy(triples.at + j);
  const Vec64 above = energy(triples.above + j);
  const Vec64 curvature = hn::Add(hn::Sub(below, hn::Add(at, at)), above);
  // Infinite curvature means an infinite neighbour; an infinite middle gives NaN or a negative
  // curvature.
  const auto is_curved = hn::And(hn::Gt(curvature, hn::Zero(d64)), hn::Lt(curvature, infinity));
  const auto has_neighbours =
      hn::And(hn::Gt(winner, candidates.first(j)), hn::Lt(winner, candidates.last(j)));
  const Vec64 lowest = hn::Div(hn::Sub(below, above), hn::Add(curvature, curvature));
  const Vec64 disparity = hn::Add(hn::Add(hn::Set(d64, disparity_min), winner),
                                  hn::IfThenElseZero(hn::And(is_curved, has_neighbours), lowest));
  return hn::IfThenElse(hn::Lt(winner, hn::Zero(d64)),
                        hn::Set(d64, std::numeric_limits<double>::quiet_NaN()), disparity);
}

template <typename Cell, class Energy, class Candidates>
HWY_INLINE void refine_block(const Triples<Cell>& triples, Energy energy,
                             const Candidates& candidates, const std::int32_t* winners, int columns,
                             int disparity_min, float* disparity_px) {
  const Tag64 d64;
  constexpr int step = static_cast<int>(hn::MaxLanes(d64));
  const auto refine = [&](int j, const std::int32_t* at, float* output) HWY_ATTR {
    const Vec64 winner = hn::PromoteTo(d64, hn::LoadU(Tag32(), at));
    const Vec64 result = refined(triples, energy, candidates, j, winner, disparity_min);
    hn::StoreU(hn::DemoteTo(TagF(), result), TagF(), output);
  };
  int j = 0;
  for (; j + step <= columns; j += step) {
    refine(j, winners + j, disparity_px + j);
  }
  if (j < columns) {
    HWY_ALIGN std::int32_t last_winners[step] = {};
    HWY_ALIGN float last[step];
    std::copy_n(winners + j, columns - j, last_winners);
    refine(j, last_winners, last);
    std::copy_n(last, columns - j, disparity_px + j);
  }
}

// Columns [begin, end) of a row in which every candidate may win.
template <class Row, typename Cell, class Energy>
HWY_INLINE void refine_plain(const Row& row, const Cell* cells, const std::int32_t* winners,
                             Energy energy, int begin, int end, float* disparity_px) {
  Triples<Cell> triples = {};
  const std::ptrdiff_t lanes = row.geometry.lanes();
  const int max = row.geometry.count - 2;
  const SameCandidates candidates{{0, row.geometry.count}};
  cells += begin * lanes;
  for (int first = begin; first < end; first += kBlock) {
    const int columns = std::min(kBlock, end - first);
    const std::int32_t* block_winners = winners + first;
    for (int j = 0; j < columns; ++j, cells += lanes) {
      triples.gather(j, cells, std::min(block_winners[j], max));
    }
    refine_block(triples, energy, candidates, block_winners, columns, row.geometry.disparity_min,
                 disparity_px + first);
  }
}

// Same for any columns.
template <class Energy>
HWY_INLINE void refine_border(const CellRow& row, const std::int32_t* winners, Energy energy,
                              int begin, int end, float* disparity_px) {
  if (begin >= end) {
    return;
  }
  Triples<float> triples = {};
  OwnCandidates candidates;
  const std::ptrdiff_t lanes = row.geometry.lanes();
  const int max = row.geometry.count - 2;
  const float* cells = row.cells + begin * lanes;
  for (int first = begin; first < end; first += kBlock) {
    const int columns = std::min(kBlock, end - first);
    for (int j = 0; j < columns; ++j, cells += lanes) {
      const CandidateRange own = row.candidates(row.first_column + first + j);
      candidates.firsts[j] = own.begin;
      candidates.lasts[j] = own.end - 1;
      triples.gather(j, cells, std::min(winners[first + j], max));
    }
    refine_block(triples, energy, candidates, winners + first, columns, row.geometry.disparity_min,
                 disparity_px + first);
  }
}

template <class Energy>
HWY_INLINE void refine_cells(const CellRow& row, const std::int32_t* winners, Energy energy,
                             float* disparity_px) {
  const CandidateRange plain = row.plain_columns();
  const int begin = plain.begin - row.first_column;
  const int end = plain.end - row.first_column;
  refine_border(row, winners, energy, 0, begin, disparity_px);
  refine_plain(row, row.cells, winners, energy, begin, end, disparity_px);
  refine_border(row, winners, energy, end, row.columns, disparity_px);
}

void parabola_cells_simd(const CellRow& row, const std::int32_t* winners, float* disparity_px) {
  if (row.probabilities) {
    refine_cells(row, winners, ProbabilityEnergy(), disparity_px);
  } else {
    refine_cells(row, winners, CellEnergy(), disparity_px);
  }
}

// Windows that are not whole have their own sample counts: scalar code.
void refine_border(const WinnerRow& row, const std::int32_t* winners, int begin, int end,
                   float* disparity_px) {
  WinnerRow part = row;
  part.cells += static_cast<std::ptrdiff_t>(begin) * row.geometry.lanes();
  part.first_column += begin;
  part.columns = end - begin;
  parabola_disparity_row_ref(part, winners + begin, disparity_px + begin);
}

void parabola_sums_simd(const WinnerRow& row, const std::int32_t* winners, float* disparity_px) {
  const CandidateRange plain = row.plain_columns();
  const int begin = plain.begin - row.first_column;
  const int end = plain.end - row.first_column;
  refine_border(row, winners, 0, begin, disparity_px);
  refine_plain(row, row.cells, winners, SumEnergy{row.index_bits}, begin, end, disparity_px);
  refine_border(row, winners, end, row.columns, disparity_px);
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vantage::kernels {
HWY_EXPORT(parabola_cells_simd);
HWY_EXPORT(parabola_sums_simd);

void parabola_disparity_row(const WinnerRow& row, const std::int32_t* winners,
                            float* disparity_px) {
  HWY_DYNAMIC_DISPATCH(parabola_sums_simd)(row, winners, disparity_px);
}

void parabola_disparity_row(const CellRow& row, const std::int32_t* winners, float* disparity_px) {
  HWY_DYNAMIC_DISPATCH(parabola_cells_simd)(row, winners, disparity_px);
}

// Scalar reference.

namespace {

constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

// Vertex of the parabola through three energies, relative to the middle one.
double lowest_point(double below, double at, double above) {
  const double curvature = below - 2 * at + above;
  return curvature > 0 ? (below - above) / (2 * curvature) : 0;
}

double energy_of(const WinnerRow& row, int j, int candidate) {
  const std::ptrdiff_t lanes = row.geometry.lanes();
  const int x = row.first_column + j;
  const CandidateRange plain = row.plain_columns();
  // Sample counts may differ, so means are compared, not sums. Where all windows are whole, sums
  // are equivalent and exact.
  const int samples = x >= plain.begin && x < plain.end ? 1 : row.window_columns(x, candidate);
  return static_cast<double>(row.sum(row.cells[j * lanes + candidate])) / samples;
}

double energy_of(const CellRow& row, int j, int candidate) {
  const std::ptrdiff_t lanes = row.geometry.lanes();
  const double cell = row.cells[j * lanes + candidate];
  return row.probabilities ? -std::log(cell) : cell;
}

template <typename Row>
float refined(const Row& row, int j, int winner) {
  const CandidateRange candidates = row.candidates(row.first_column + j);
  const int disparity_px = row.geometry.disparity_min + winner;
  if (winner <= candidates.begin || winner + 1 >= candidates.end) {
    return winner == kNoWinner ? kUnknown : static_cast<float>(disparity_px);
  }
  const double below = energy_of(row, j, winner - 1);
  const double at = energy_of(row, j, winner);
  const double above = energy_of(row, j, winner + 1);
  if (std::isinf(below) || std::isinf(at) || std::isinf(above)) {
    return static_cast<float>(disparity_px);
  }
  return static_cast<float>(disparity_px + lowest_point(below, at, above));
}

template <typename Row>
void integer_disparities(const Row& row, const std::int32_t* winners, float* disparity_px) {
  for (int j = 0; j < row.columns; ++j) {
    disparity_px[j] = winners[j] == kNoWinner
                          ? kUnknown
                          : static_cast<float>(row.geometry.disparity_min + winners[j]);
  }
}

template <typename Row>
void refined_disparities(const Row& row, const std::int32_t* winners, float* disparity_px) {
  for (int j = 0; j < row.columns; ++j) {
    disparity_px[j] = refined(row, j, winners[j]);
  }
}

}  // namespace

void integer_disparity_row(const WinnerRow& row, const std::int32_t* winners, float* disparity_px) {
  integer_disparities(row, winners, disparity_px);
}

void integer_disparity_row(const CellRow& row, const std::int32_t* winners, float* disparity_px) {
  integer_disparities(row, winners, disparity_px);
}

void parabola_disparity_row_ref(const WinnerRow& row, const std::int32_t* winners,
                                float* disparity_px) {
  refined_disparities(row, winners, disparity_px);
}

void parabola_disparity_row_ref(const CellRow& row, const std::int32_t* winners,
                                float* disparity_px) {
  refined_disparities(row, winners, disparity_px);
}

}  // namespace vantage::kernels
#endif
