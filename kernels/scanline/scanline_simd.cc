#include "kernels/simd-inl.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "kernels/scanline/scanline.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {

using Tag = hn::ScalableTag<float>;
using Vec = hn::VFromD<Tag>;

/// Spreads path energies over changes of `step` candidates in both directions.
HWY_INLINE void spread_paths(const float* paths, int lanes, int step, float cost, float* output) {
  const Tag d;
  const Vec costs = hn::Set(d, cost);
  for (int i = 0; i < lanes; i += static_cast<int>(hn::Lanes(d))) {
    const Vec beside = hn::Min(hn::LoadU(d, paths + i - step), hn::LoadU(d, paths + i + step));
    hn::Store(hn::Min(hn::Load(d, paths + i), hn::Add(beside, costs)), d, output + i);
  }
}

/// Path energies of a column, also in `copy`, and their minimum. before(i): the cheapest way to
/// lane i, relative to the minimum of the column before.
template <class Before>
HWY_INLINE float make_paths(const float* cells, int lanes, CandidateRange candidates,
                            const Before& before, float* paths, float* copy) {
  const Tag d;
  const Vec never = hn::Set(d, std::numeric_limits<float>::infinity());
  const Vec begin = hn::Set(d, static_cast<float>(candidates.begin));
  const Vec end = hn::Set(d, static_cast<float>(candidates.end));
  Vec min = never;
  for (int i = 0; i < lanes; i += static_cast<int>(hn::Lanes(d))) {
    const Vec lane = hn::Iota(d, static_cast<float>(i));
    const auto counts = hn::And(hn::Ge(lane, begin), hn::Lt(lane, end));
    const Vec path = hn::IfThenElse(counts, hn::Add(hn::LoadU(d, cells + i), before(i)), never);
    hn::Store(path, d, paths + i);
    hn::Store(path, d, copy + i);
    min = hn::Min(min, path);
  }
  return hn::GetLane(hn::MinOfLanes(d, min));
}

void scanline_paths_simd(const CellRow& row, const JumpCost& jump, const ScanlineWork& work) {
  const Tag d;
  const int lanes = row.geometry.lanes();
  const int passes = jump.passes(row.geometry.count);
  const int size = scanline_spread_floats(row.geometry, jump) / 2;
  const int margin = (size - lanes) / 2;
  std::fill_n(work.spread, 2 * size, std::numeric_limits<float>::infinity());
  float* spread = work.spread + margin;
  float* other = spread + size;
  const Vec limit = hn::Set(d, jump.limit);
  bool continues = false;
  float min_before = 0;
  for (int j = 0; j < row.columns; ++j) {
    const float* cells = row.cells + static_cast<std::ptrdiff_t>(j) * lanes;
    float* paths = work.paths + static_cast<std::ptrdiff_t>(j) * lanes;
    const CandidateRange candidates = row.candidates(row.first_column + j);
    if (continues) {
      for (int pass = 0; pass < passes; ++pass) {
        const int step = 1 << pass;
        spread_paths(spread, lanes, step, jump.penalty * static_cast<float>(step), other);
        std::swap(spread, other);
      }
      const Vec min = hn::Set(d, min_before);
      const Vec most = hn::Add(min, limit);
      const float* const from = spread;
      min_before = make_paths(
          cells, lanes, candidates,
          [&](int i) HWY_ATTR { return hn::Sub(hn::Min(hn::Load(d, from + i), most), min); }, paths,
          spread);
    } else {
      min_before = make_paths(
          cells, lanes, candidates, [&](int /*i*/) HWY_ATTR { return hn::Zero(d); }, paths, spread);
    }
    work.minima[j] = min_before;
    continues = !candidates.empty();
  }
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vantage::kernels {
HWY_EXPORT(scanline_paths_simd);

void scanline_winners_row(const CellRow& row, const JumpCost& jump, const ScanlineWork& work,
                          std::int32_t* winners) {
  HWY_DYNAMIC_DISPATCH(scanline_paths_simd)(row, jump, work);
  trace_scanline_row(row, jump, work, winners);
}

namespace {

int first_minimum(const float* paths, CandidateRange candidates) {
  return static_cast<int>(std::min_element(paths + candidates.begin, paths + candidates.end) -
                          paths);
}

/// The candidate of a column that the best path to `candidate` of the next column comes from.
int predecessor(const float* paths, float min, const JumpCost& jump, int linear_changes, int count,
                CandidateRange candidates, int candidate) {
  int best = candidate;
  float energy = paths[candidate];
  for (int k = 1; k <= linear_changes; ++k) {
    const float cost = jump.of(k);
    if (min + cost >= energy) {
      return best;  // nor do larger changes pay
    }
    for (const int other : {candidate - k, candidate + k}) {
      if (other >= 0 && other < count && paths[other] + cost < energy) {
        energy = paths[other] + cost;
        best = other;
      }
    }
  }
  return min + jump.limit < energy ? first_minimum(paths, candidates) : best;
}

}  // namespace

int JumpCost::linear_changes(int count) const {
  int changes = 0;
  while (changes < count - 1 && penalty * static_cast<float>(changes + 1) < limit) {
    ++changes;
  }
  return changes;
}

int JumpCost::passes(int count) const {
  int passes = 0;
  while ((1 << passes) - 1 < linear_changes(count)) {
    ++passes;
  }
  return passes;
}

int scanline_spread_floats(const CandidateGeometry& geometry, const JumpCost& jump) {
  // Two columns with room on both sides for the longest step of a pass.
  const int passes = jump.passes(geometry.count);
  const int reach = passes == 0 ? 0 : 1 << (passes - 1);
  const int margin = CandidateGeometry{.count = reach}.lanes();
  return 2 * (geometry.lanes() + 2 * margin);
}

void trace_scanline_row(const CellRow& row, const JumpCost& jump, const ScanlineWork& work,
                        std::int32_t* winners) {
  const int count = row.geometry.count;
  const int linear_changes = jump.linear_changes(count);
  int next = kNoWinner;
  for (int j = row.columns - 1; j >= 0; --j) {
    const float* paths = work.paths + static_cast<std::ptrdiff_t>(j) * row.geometry.lanes();
    const CandidateRange candidates = row.candidates(row.first_column + j);
    if (candidates.empty()) {
      next = kNoWinner;
    } else if (next == kNoWinner) {
      next = first_minimum(paths, candidates);
    } else {
      next = predecessor(paths, work.minima[j], jump, linear_changes, count, candidates, next);
    }
    winners[j] = next;
  }
}

}  // namespace vantage::kernels
#endif
