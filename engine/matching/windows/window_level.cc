#include "engine/matching/windows/window_level.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <utility>
#include <vector>

#include "engine/matching/windows/window_evidence.h"
#include "engine/matching/windows/window_format.h"
#include "engine/matching/windows/window_rows.h"
#include "engine/matching/windows/window_starter.h"
#include "engine/object_pool.h"
#include "kernels/window_step/window_step.h"
#include "scheduler/range.h"

namespace vantage {
namespace {

using kernels::kWindowCandidates;
using kernels::kWindows;
using kernels::WindowCells;
using scheduler::Range;
using scheduler::Region;

/// Rows per task: few enough to balance, enough that the rows made twice, around bands, are few.
constexpr int kBandRows = 32;

/// What all tasks of a level share.
struct Level {
  const WindowLevelInput& input;
  Subpixel subpixel;
  const WindowLevelOutput& output;
  WindowFormat format;
  kernels::WindowPrior prior;
  const WindowEvidence& evidence;
  int columns;
  int rows;
  int iterations;
};

/// Iterations before the last one, which selects.
int steps_of(int iterations) { return iterations - 1; }
/// Columns around those of a result that its iterations read, one more than iterations make wrong.
int halo_columns(int iterations) { return iterations + 1; }
/// Rows likewise: those of each step read two.
int halo_rows(int iterations) { return 2 * steps_of(iterations) + 1; }

/// One region of a level, swept by all iterations as a wavefront of pairs of rows, those that a
/// coarse row covers. A region below the last one continues its sweep. Each iteration makes the
/// outermost columns of its halo wrong; nothing of the halo is in the result.
class Band {
 public:
  explicit Band(const Level& level)
      : level_(level),
        starter_(level.input.coarse, level.input.spacing, level.input.geometry.disparity_min,
                 level.input.geometry.count, level.prior, level.format.nats_per_step()),
        steps_(steps_of(level.iterations)),
        starts_(steps_ + 4, level.columns),
        evidence_(2 * (steps_ + 1), level.columns),
        states_(2 * steps_ + 3, level.columns),
        state_(level.columns),
        absent_(level.columns),
        selectable_(level.columns),
        window_(level.columns),
        lane_(level.columns),
        total_(level.columns),
        total_before_(level.columns),
        total_after_(level.columns),
        support_(level.columns),
        uniform_(level.columns) {
    mu_ = kernels::fixed_weight(static_cast<float>(level.input.parameters.mu));
    std::fill_n(uniform_.data(), level.columns + 1, mu_);
    for (auto& selectable : selectable_.cells) {
      std::fill_n(selectable.data(), level.columns, ~WindowCells{0});
    }
  }

  /// Whether `region` lies directly below the last one.
  [[nodiscard]] bool continues_at(const Region& region) const {
    return region.rows.begin == end_ && end_ % 2 == 0 && region.columns == result_;
  }

  void run(const Region& region) {
    const Range rows = region.rows;
    const int first_pair = rows.begin / 2;
    const int end_pair = (rows.end + 1) / 2;
    if (!continues_at(region)) {
      result_ = region.columns;
      columns_ = region.columns.widened(halo_columns(level_.iterations), {0, level_.columns});
      columns_.begin -= columns_.begin % 2;  // at a coarse column
      first_pair_ = first_pair;
      next_pair_ = std::max(0, first_pair - steps_);
      coarse_end_ = std::max(0, next_pair_ - 1);
    }
    end_ = rows.end;
    for (; next_pair_ < end_pair + steps_; ++next_pair_) {
      if (2 * next_pair_ < level_.rows) {
        prepare_pair(next_pair_);
      }
      for (int i = 1; i <= steps_; ++i) {
        make_row(2 * (next_pair_ - i + 1), i);
        make_row(2 * (next_pair_ - i) + 1, i);
      }
      const int finished = 2 * (next_pair_ - steps_);
      for (int y = std::max(rows.begin, finished); y < std::min(rows.end, finished + 2); ++y) {
        select(y);
      }
    }
  }

 private:
  /// The windows of a pair's rows and their evidence.
  void prepare_pair(int pair) {
    const int coarse_rows = level_.input.coarse.extent().rows;
    for (; coarse_end_ < std::min(pair + 2, coarse_rows); ++coarse_end_) {
      starter_.make_row(coarse_end_, columns_, starts_.at(coarse_end_));
    }
    WindowStartRow& starts = starts_.at(pair);
    WindowStarter::mark_near(pair > 0 ? &starts_.at(pair - 1) : nullptr,
                             pair + 1 < coarse_rows ? &starts_.at(pair + 1) : nullptr, columns_,
                             starts);
    for (int y = 2 * pair; y < std::min(2 * pair + 2, level_.rows); ++y) {
      level_.evidence.make_row(y, columns_, starts, evidence_.at(y));
    }
  }

  /// Row y after step `step`, if later ones read it. Even rows come first and are read by odd ones.
  void make_row(int y, int step) {
    if (y < 0 || y >= level_.rows || y / 2 < first_pair_ - 1 - steps_ + step) {
      return;
    }
    kernels::window_step_row(step_row(y, columns_, step), from(columns_, state_.data()));
    std::swap(state_, states_.at(y));
  }

  /// Both windows' values from the first of `columns` on.
  template <typename T>
  static std::array<T*, kWindows> from(Range columns, const std::array<T*, kWindows>& values) {
    return {values[0] + columns.begin, values[1] + columns.begin};
  }

  /// Columns `columns` of row y. is_start: before the first step.
  kernels::WindowRow windows(int y, Range columns, bool is_start) {
    if (y < 0 || y >= level_.rows) {
      const auto absent = from(columns, absent_.data());
      return {.support = {absent[0], absent[1]},
              .start = from(columns, starts_.at(std::max(y, 0) / 2).starts())};
    }
    WindowStartRow& starts = starts_.at(y / 2);
    const auto support = from(columns, is_start ? starts.support.data() : states_.at(y).data());
    return {.support = {support[0], support[1]}, .start = from(columns, starts.starts())};
  }

  kernels::WindowStepRow step_row(int y, Range columns, int iteration) {
    kernels::WindowStepRow row;
    const bool is_selected = iteration == level_.iterations;
    const bool is_first = iteration == 1;
    const bool reads_start = is_first && (is_selected || y % 2 == 0);
    row.up = windows(y - 1, columns, reads_start);
    row.centre = windows(y, columns, is_first);
    row.down = windows(y + 1, columns, reads_start);
    const auto evidence = from(columns, evidence_.at(y).data());
    row.evidence = {evidence[0], evidence[1]};
    const WindowStartRow& starts = starts_.at(y / 2);
    row.has_second = starts.has_second.data() + columns.begin;
    row.near_second = starts.near_second.data() + columns.begin;
    row.mu = mu_;
    row.beside = row.above = row.below = uniform_.data();
    if (const EdgeWeights* const edges = level_.input.edges; edges != nullptr) {
      const EdgeWeightPlanes& weights = edges->of_iteration(iteration);
      row.beside = weights.fixed_beside(y) + columns.begin;
      row.above = weights.fixed_above(y) + columns.begin;
      row.below = weights.fixed_above(y + 1) + columns.begin;
    }
    row.prior = level_.prior;
    row.columns = columns.size();
    return row;
  }

  /// The last iteration of row y, and its winners.
  void select(int y) {
    // Pairs of columns have the same windows.
    const Range pairs{result_.begin / 2 * 2, result_.end};
    const kernels::WindowStepRow row = step_row(y, pairs, level_.iterations);
    const WindowStartRow& starts = starts_.at(y / 2);
    const bool needs_support = level_.output.state != nullptr || !level_.output.confidence.empty();
    const auto winners_from = [&](int x) {
      return kernels::WindowWinners{.window = window_.data() + x,
                                    .lane = lane_.data() + x,
                                    .total = total_.data() + x,
                                    .total_before = total_before_.data() + x,
                                    .total_after = total_after_.data() + x,
                                    .support = needs_support ? support_.data() + x : nullptr};
    };
    kernels::WindowWinners winners = winners_from(pairs.begin);
    const auto selectable = selectable_.data();
    if (!level_.evidence.has_all_partners()) {
      // Set to all at first; only outer columns change.
      level_.evidence.for_each_outer_column(pairs, [&](int x) {
        for (std::size_t q = 0; q < kWindows; ++q) {
          selectable[q][x] = level_.evidence.with_partner(x, starts.start[q].data()[x]);
        }
      });
      winners.selectable = {selectable[0] + pairs.begin, selectable[1] + pairs.begin};
    }
    kernels::window_winners_row(row, winners);
    const kernels::WindowWinners of_result = winners_from(result_.begin);
    float* const disparity_px = level_.output.disparity_px.row(y);
    kernels::window_disparity_row(
        {.winners = &of_result,
         .start = from(result_, starts.starts()),
         .disparity_min = level_.input.geometry.disparity_min,
         .candidates = std::min(kWindowCandidates, level_.input.geometry.count),
         .is_refined = level_.subpixel == Subpixel::kParabola,
         .columns = result_.size()},
        disparity_px + result_.begin);
    level_.evidence.for_each_outer_column(result_, [&](int x) {
      if (window_.data()[x] != kernels::kNoWindow && !has_partners_beside(x)) {
        disparity_px[x] =
            static_cast<float>(level_.input.geometry.disparity_min + winner(x, starts));
      }
    });
    if (!level_.output.confidence.empty()) {
      write_confidence(level_.output.confidence.row(y));
    }
    if (level_.output.state != nullptr) {
      write_state(y, starts, *level_.output.state);
    }
  }

  /// Candidate that wins in column x.
  [[nodiscard]] int winner(int x, const WindowStartRow& starts) const {
    const std::size_t window = window_.data()[x] == 1 ? 1 : 0;
    return starts.start[window].data()[x] + lane_.data()[x];
  }

  /// Whether the candidates before and after the winner have partners, too.
  [[nodiscard]] bool has_partners_beside(int x) {
    const WindowCells selectable = selectable_.cells[window_.data()[x]].data()[x];
    const int lane = lane_.data()[x];
    return lane > 0 && lane + 1 < kWindowCandidates &&
           kernels::window_cell(selectable, lane - 1) != 0 &&
           kernels::window_cell(selectable, lane + 1) != 0;
  }

  void write_confidence(float* confidence) const {
    for (int x = result_.begin; x < result_.end; ++x) {
      if (window_.data()[x] == kernels::kNoWindow) {
        confidence[x] = std::numeric_limits<float>::quiet_NaN();
        continue;
      }
      const auto cell = [&](int lane) { return kernels::window_cell(support_.data()[x], lane); };
      double sum = 0;
      for (int k = 0; k < kWindowCandidates; ++k) {
        if (kernels::window_cell(level_.prior.lanes, k) != 0) {
          sum += std::exp((cell(k) - cell(lane_.data()[x])) * level_.format.nats_per_step());
        }
      }
      confidence[x] = static_cast<float>(1 / sum);
    }
  }

  void write_state(int y, const WindowStartRow& starts, WindowState& state) const {
    std::copy_n(support_.data() + result_.begin, result_.size(),
                state.support.row(y) + result_.begin);
    for (int x = result_.begin; x < result_.end; ++x) {
      const int candidate = winner(x, starts);
      state.start.at(x, y) = static_cast<std::int16_t>(candidate - lane_.data()[x]);
      state.winner.at(x, y) = static_cast<std::int16_t>(candidate);
    }
  }

  const Level& level_;
  Range result_;   ///< columns of the region
  Range columns_;  ///< and of its halo
  WindowStarter starter_;
  int steps_;
  RowRing<WindowStartRow> starts_;  ///< of coarse rows
  int coarse_end_ = 0;              ///< coarse rows before this one are made
  int first_pair_ = 0;              ///< of the sweep
  int next_pair_ = 0;
  int end_ = -1;  ///< of the last region's rows
  RowRing<WindowCellsRow> evidence_;
  RowRing<WindowCellsRow> states_;  ///< after the last step that made each row
  WindowCellsRow state_;            ///< the next one of a row
  WindowCellsRow absent_;           ///< of rows outside the image
  WindowCellsRow selectable_;
  WindowValues<std::uint8_t> window_;
  WindowValues<std::uint8_t> lane_;
  WindowValues<std::uint16_t> total_;
  WindowValues<std::uint16_t> total_before_;
  WindowValues<std::uint16_t> total_after_;
  WindowValues<WindowCells> support_;
  kernels::FixedWeight mu_ = 0;
  WindowValues<kernels::FixedWeight> uniform_;
};

/// The whole level.
std::vector<Region> bands_of(const Level& level) {
  std::vector<Region> bands;
  for (int row = 0; row < level.rows; row += kBandRows) {
    bands.push_back({{0, level.columns}, {row, std::min(row + kBandRows, level.rows)}});
  }
  return bands;
}

}  // namespace

kernels::CandidateGeometry window_margins(kernels::CandidateGeometry geometry) {
  const int reach = std::max(std::abs(geometry.disparity_min),
                             std::abs(geometry.disparity_min + geometry.count)) +
                    2 * kWindowCandidates;
  geometry.disparity_min = -reach;
  geometry.count = 2 * reach + 1;
  return geometry;
}

int coarse_reach(int iterations) {
  // And neighbours of coarse pixels, and theirs.
  return (std::max(halo_columns(iterations), halo_rows(iterations)) + 1) / 2 + 2;
}

void search_windows(const WindowLevelInput& input, Subpixel subpixel,
                    const WindowLevelOutput& output, Execution& execution) {
  const WindowFormat format(input.parameters);
  const int columns = output.disparity_px.width();
  const kernels::WindowPrior prior = format.prior(input.geometry.count);
  const WindowEvidence evidence(input, format, columns, prior.lanes);
  const Level level{.input = input,
                    .subpixel = subpixel,
                    .output = output,
                    .format = format,
                    .prior = prior,
                    .evidence = evidence,
                    .columns = columns,
                    .rows = output.disparity_px.height(),
                    .iterations = input.parameters.iterations};
  if (output.state != nullptr) {
    output.state->resize({level.columns, level.rows});
    output.state->disparity_min = input.geometry.disparity_min;
    output.state->ceiling = format.ceiling();
    output.state->nats_per_step = format.nats_per_step();
  }
  const std::vector<Region> regions = output.regions != nullptr ? *output.regions : bands_of(level);
  ObjectPool<Band> bands;
  execution.executor().parallel_for(static_cast<int>(regions.size()), [&](int task) {
    const Region& region = regions[static_cast<std::size_t>(task)];
    bands.borrow_best([&](const Band& band) { return band.continues_at(region); }, level)
        ->run(region);
  });
}

}  // namespace vantage
