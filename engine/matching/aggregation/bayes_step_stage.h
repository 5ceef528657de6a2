#pragma once

#include <string_view>

#include "engine/image/image.h"
#include "engine/matching/aggregation/star_stage.h"
#include "kernels/candidates.h"
#include "scheduler/row_stage.h"

namespace vantage {

/// Common base of the stages of Bayesian diffusion, for any cell format: the start, which makes the
/// state before the first iteration from its input, and the iterations, which read that input
/// again. Cell: float or kernels::FixedEnergy.
template <typename Cell>
class BayesStepStage : public CellStarStage<Cell> {
  using Star = CellStarStage<Cell>;

 public:
  /// neutral: cell value of neighbours outside the image.
  BayesStepStage(const kernels::CandidateGeometry& geometry, int height, bool is_start,
                 Cell neutral)
      : Star(geometry, height), is_start_(is_start), neutral_(Star::lanes(), 1) {
    neutral_.fill(neutral);
  }

  [[nodiscard]] std::string_view name() const override {
    return is_start_ ? "Bayes start" : "Bayes iteration";
  }
  [[nodiscard]] bool reads_source() const override { return !is_start_; }
  [[nodiscard]] scheduler::Range input_rows(int y, scheduler::Extent input) const override {
    return is_start_ ? scheduler::RowStage::input_rows(y, input) : Star::input_rows(y, input);
  }
  [[nodiscard]] scheduler::Range input_columns(scheduler::Range columns,
                                               scheduler::Extent input) const override {
    return is_start_ ? scheduler::RowStage::input_columns(columns, input)
                     : Star::input_columns(columns, input);
  }
  [[nodiscard]] int window_rows() const override { return is_start_ ? 1 : 3; }

 protected:
  [[nodiscard]] bool is_start() const { return is_start_; }
  /// The column used for neighbours outside the image.
  [[nodiscard]] const Cell* neutral() const { return neutral_.row(0); }
  /// The star of all columns of the task. In the start, star.source is star.centre.
  [[nodiscard]] kernels::CellStarRow<Cell> step_star(const scheduler::RowTask& task) const {
    kernels::CellStarRow<Cell> star = Star::star(task, Star::lanes(), neutral());
    if (is_start_) {
      star.source = star.centre;
    }
    return star;
  }

 private:
  bool is_start_;
  Image<Cell> neutral_;
};

}  // namespace vantage
