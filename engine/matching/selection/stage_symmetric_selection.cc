#include "engine/matching/selection/stage_symmetric_selection.h"
#include "engine/matching/selection/whole_row_stage.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>

#include "engine/column_work.h"
#include "engine/image/side.h"
#include "kernels/symmetric_path/symmetric_path.h"

namespace vantage {
namespace {

using kernels::StepEnergy;
using kernels::SymmetricRow;
using scheduler::Extent;
using scheduler::Range;

constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

/// A pair of pixels.
struct Pair {
  int left_column = 0;
  int candidate = 0;
};

/// Cost of a pair, if there is one that may be matched.
std::optional<double> cost_of(const SymmetricRow& row, Pair pair) {
  const int right = pair.left_column - row.disparity_min - pair.candidate;
  if (pair.candidate < 0 || pair.candidate >= row.count || pair.left_column < 0 ||
      pair.left_column >= row.width || right < 0 || right >= row.width) {
    return {};
  }
  const std::int32_t cost = row.cost(pair.left_column, pair.candidate);
  return cost == SymmetricRow::kNever ? std::nullopt : std::optional<double>(cost);
}

/// §3.9, at most half a pixel.
std::optional<double> parabola(std::optional<double> below, double at,
                               std::optional<double> above) {
  if (!below || !above) {
    return {};
  }
  const double curvature = *below - 2 * at + *above;
  return curvature > 0 ? std::clamp((*below - *above) / (2 * curvature), -0.5, 0.5) : 0;
}

/// The mean of the parabolas through the candidates of the left and of the right pixel.
double subpixel_position(const SymmetricRow& row, Pair pair) {
  const auto [x, i] = pair;
  const double at = *cost_of(row, pair);
  const auto of_left = parabola(cost_of(row, {x, i - 1}), at, cost_of(row, {x, i + 1}));
  const auto of_right = parabola(cost_of(row, {x - 1, i - 1}), at, cost_of(row, {x + 1, i + 1}));
  return of_left && of_right ? (*of_left + *of_right) / 2 : of_left.value_or(of_right.value_or(0));
}

class SymmetricSelectionStage final : public WholeRowStage {
 public:
  SymmetricSelectionStage(std::unique_ptr<RowEnergies> energies, const LevelVolume& right,
                          const SymmetricSettings& settings, const MapOutputs& left_outputs,
                          const MapOutputs& right_outputs)
      : WholeRowStage({energies->geometry().width, left_outputs.disparity_px.height()}),
        energies_(std::move(energies)),
        geometry_(energies_->geometry()),
        right_(right),
        settings_(settings),
        outputs_{left_outputs, right_outputs} {}

  [[nodiscard]] std::string_view name() const override { return "symmetric selection"; }
  [[nodiscard]] std::size_t state_bytes(Range /*columns*/, Extent /*input*/) const override {
    return place(nullptr).bytes;
  }
  [[nodiscard]] scheduler::ColumnWork column_work() const override {
    return vantage::column_work(
        energies_->work() + kernels::kStepEnergiesWork + kernels::kSymmetricPathWork,
        geometry_.count);
  }
  /// The task of the first columns makes the row: a path cannot be cut.
  void make_row(const scheduler::RowTask& task) const override {
    if (task.columns.begin > 0) {
      return;
    }
    const Place at = place(task.state);
    settings_.steps.convert(energies_->energies(task.input, task.y, at.energies), at.left);
    const SymmetricRow row = row_of(at.left, right_.column<StepEnergy>(0, task.y));
    kernels::symmetric_matches_row(row, at.sums, at.matches[0], at.matches[1]);
    write_matches(row, at.matches, task.y);
    for (const Side side : {Side::kLeft, Side::kRight}) {
      if (compares_energies() && !outputs_of(side).confidence.empty()) {
        write_confidence(row, side, at, task.y);
      }
    }
  }

 private:
  /// Parts of the state.
  struct Place {
    std::byte* energies = nullptr;
    StepEnergy* left = nullptr;
    std::int32_t* sums = nullptr;
    std::int32_t* matches[2] = {};   ///< of the left and the right image
    float* pair_energies = nullptr;  ///< those of one image's pixels
    float* minima = nullptr;         ///< of those
    std::size_t bytes = 0;
  };
  [[nodiscard]] Place place(std::byte* state) const {
    const auto width = static_cast<std::size_t>(geometry_.width);
    const std::size_t cells = width * static_cast<std::size_t>(geometry_.lanes());
    Place at;
    const auto take = [&]<typename T>(std::size_t count, T*& part) {
      part = state == nullptr ? nullptr : reinterpret_cast<T*>(state + at.bytes);
      at.bytes += cache_aligned(sizeof(T) * count);
    };
    take(cells, at.left);
    take(kernels::symmetric_path_sums(row_of(nullptr, nullptr)), at.sums);
    take(width, at.matches[0]);
    take(width, at.matches[1]);
    take(compares_energies() ? cells : 0, at.pair_energies);
    take(compares_energies() ? width : 0, at.minima);
    take(energies_->work_bytes(), at.energies);
    return at;
  }
  [[nodiscard]] SymmetricRow row_of(const StepEnergy* left, const StepEnergy* right) const {
    return {.left = left,
            .right = right,
            .width = geometry_.width,
            .lanes = geometry_.lanes(),
            .disparity_min = geometry_.disparity_min,
            .count = geometry_.count,
            .match_offset = settings_.steps.match_offset,
            .unmatched = settings_.steps.unmatched};
  }
  [[nodiscard]] const MapOutputs& outputs_of(Side side) const {
    return outputs_[side == Side::kLeft ? 0 : 1];
  }
  /// Whether the confidence needs the energies of all candidates.
  [[nodiscard]] bool compares_energies() const {
    return settings_.confidence == ConfidenceMeasure::kMargin ||
           settings_.confidence == ConfidenceMeasure::kEntropy;
  }

  void write_matches(const SymmetricRow& row, std::int32_t* const* matches, int y) const {
    const auto set = [&](const MapOutputs& outputs, int x, float disparity_px, float energy) {
      outputs.disparity_px.row(y)[x] = disparity_px;
      if (!outputs.confidence.empty() && !compares_energies()) {
        outputs.confidence.row(y)[x] =
            settings_.confidence == ConfidenceMeasure::kEvidence ? -energy : std::exp(-energy);
      }
    };
    for (int x = 0; x < row.width; ++x) {
      if (matches[1][x] == kernels::kNoWinner) {
        set(outputs_[1], x, kUnknown, kUnknown);
      }
      const int candidate = matches[0][x];
      if (candidate == kernels::kNoWinner) {
        set(outputs_[0], x, kUnknown, kUnknown);
        continue;
      }
      const int whole_px = row.disparity_min + candidate;
      const double delta =
          settings_.subpixel == Subpixel::kParabola ? subpixel_position(row, {x, candidate}) : 0;
      const auto disparity_px = static_cast<float>(whole_px + delta);
      const float energy = settings_.steps.energy(row.cost(x, candidate));
      set(outputs_[0], x, disparity_px, energy);
      set(outputs_[1], x - whole_px, disparity_px, energy);
    }
  }

  /// Margin or entropy of the pixels of one image.
  void write_confidence(const SymmetricRow& row, Side side, const Place& at, int y) const {
    const bool is_left = side == Side::kLeft;
    const float most = settings_.steps.energy(2 * kernels::kNeverMatched + row.match_offset);
    kernels::CellRow cells;
    cells.cells = at.pair_energies;
    cells.geometry = geometry_;
    cells.geometry.direction = is_left ? -1 : 1;
    cells.columns = row.width;
    for (int x = 0; x < row.width; ++x) {
      float* const of_pixel = at.pair_energies + static_cast<std::ptrdiff_t>(x) * row.lanes;
      for (int i = 0; i < row.lanes; ++i) {
        const auto cost = cost_of(row, {is_left ? x : x + row.disparity_min + i, i});
        of_pixel[i] = cost ? settings_.steps.energy(static_cast<std::int32_t>(*cost)) : most;
      }
    }
    float* const confidence = outputs_of(side).confidence.row(y);
    if (settings_.confidence == ConfidenceMeasure::kMargin) {
      kernels::select_cell_winners_row(cells, {nullptr, nullptr, confidence});
      return;
    }
    kernels::select_cell_winners_row(cells, {nullptr, at.minima, nullptr});
    kernels::cell_entropy_row(cells, at.minima, settings_.entropy_scale, confidence);
  }

  std::unique_ptr<RowEnergies> energies_;
  kernels::CandidateGeometry geometry_;
  const LevelVolume& right_;
  SymmetricSettings settings_;
  MapOutputs outputs_[2];  ///< of the left and the right image
};

}  // namespace

std::unique_ptr<scheduler::RowStage> make_symmetric_selection_stage(
    std::unique_ptr<RowEnergies> energies, const LevelVolume& right,
    const SymmetricSettings& settings, const MapOutputs& left_outputs,
    const MapOutputs& right_outputs) {
  return std::make_unique<SymmetricSelectionStage>(std::move(energies), right, settings,
                                                   left_outputs, right_outputs);
}

}  // namespace vantage
