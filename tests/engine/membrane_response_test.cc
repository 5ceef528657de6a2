// The membrane's support function: the response to an impulse after many iterations is the inverse
// Fourier transform of (6.12).

#include <opencv2/core.hpp>

#include "engine/execution.h"
#include "engine/matching/aggregation/stage_diffusion.h"
#include "scheduler/strip_pipeline.h"
#include "scheduler/whole_image_pipeline.h"
#include "tests/engine/engine_test.h"
#include "tests/engine/plain_aggregation.h"

namespace vantage::membrane_response_test {

constexpr int kSide = 64;
constexpr int kCentre = kSide / 2;
constexpr int kLanes = kernels::kLaneMultiple;

/// Disparity space with a 1 in candidate i at (centre − i, centre), else 0.
class Impulses final : public scheduler::RowStage {
 public:
  Impulses() : RowStage({kSide, kSide}) {}
  [[nodiscard]] std::string_view name() const override { return "impulses"; }
  [[nodiscard]] std::size_t bytes_per_column() const override { return sizeof(float) * kLanes; }
  void make_row(const scheduler::RowTask& task) const override {
    auto* cells = reinterpret_cast<float*>(task.output);
    std::fill_n(cells, task.columns.size() * kLanes, 0.0F);
    for (int x = task.columns.begin; task.y == kCentre && x < task.columns.end; ++x) {
      if (x <= kCentre && kCentre - x < kLanes) {
        cells[(x - task.columns.begin) * kLanes + kCentre - x] = 1;
      }
    }
  }
};

/// Keeps one candidate of the cells.
class CellSink final : public scheduler::RowStage {
 public:
  CellSink(int lane, std::vector<float>& cells)
      : RowStage({kSide, kSide}), lane_(lane), cells_(cells) {}
  [[nodiscard]] std::string_view name() const override { return "sink"; }
  [[nodiscard]] std::size_t bytes_per_column() const override { return 0; }
  void make_row(const scheduler::RowTask& task) const override {
    const auto* row = task.input.row<float>(task.y);
    for (int x = task.columns.begin; x < task.columns.end; ++x) {
      cells_[static_cast<std::size_t>(task.y * kSide + x)] =
          row[(x - task.input.columns().begin) * kLanes + lane_];
    }
  }

 private:
  int lane_;
  std::vector<float>& cells_;
};

/// (6.12) sampled at the frequencies of a periodic image, transformed back.
cv::Mat1d support_function(double beta) {
  cv::Mat2d spectrum(kSide, kSide);  // complex; a real one would be taken for packed
  for (const auto [u, v] : positions_of(kSide, kSide)) {
    const double waves = 2 * std::cos(2 * CV_PI * u / kSide) + 2 * std::cos(2 * CV_PI * v / kSide);
    spectrum(v, u) = {beta / (beta + 4 - waves), 0};
  }
  cv::Mat1d response;
  cv::dft(spectrum, response, cv::DFT_INVERSE | cv::DFT_SCALE | cv::DFT_REAL_OUTPUT);
  return response;
}

std::vector<float> response_of(double lambda, double beta, int iterations, int lane,
                               bool in_strips) {
  MethodParameters parameters = book_parameters(MatchMethod::kMembrane);
  parameters.lambda = lambda;
  parameters.beta = beta;
  const kernels::CandidateGeometry geometry{kSide, 0, kLanes, -1};
  std::vector<float> cells(static_cast<std::size_t>(kSide * kSide));
  std::vector<std::unique_ptr<scheduler::RowStage>> stages;
  stages.push_back(std::make_unique<Impulses>());
  for (int n = 0; n < iterations; ++n) {
    stages.push_back(make_diffusion_stage(parameters, geometry, kSide));
  }
  stages.push_back(std::make_unique<CellSink>(lane, cells));
  std::vector<const scheduler::RowStage*> chain;
  for (const auto& stage : stages) {
    chain.push_back(stage.get());
  }
  if (in_strips) {
    Execution execution({.threads = 2});
    scheduler::PlanRequest request;
    request.threads = 2;
    const auto plan = scheduler::plan_chain(chain, execution.machine(), request);
    scheduler::run_strips(chain, plan, execution.executor(), execution.scratch());
  } else {
    scheduler::run_whole_image(chain);
  }
  return cells;
}

TEST(MembraneResponse, IsTheInverseTransformOfTheSupportFunction) {
  struct Case {
    double lambda;
    double beta;
  };
  for (const Case& c : {Case{.15, .5}, Case{.2, .5}, Case{.15, .7}, Case{.12, 2}}) {
    const cv::Mat1d expected = support_function(c.beta);
    for (const bool in_strips : {false, true}) {
      const std::vector<float> cells = response_of(c.lambda, c.beta, 250, 0, in_strips);
      double sum = 0;
      double worst = 0;
      for (const auto [x, y] : positions_of(kSide, kSide)) {
        const double cell = cells[static_cast<std::size_t>(y * kSide + x)];
        const double wanted =
            expected((y - kCentre + kSide) % kSide, (x - kCentre + kSide) % kSide);
        worst = std::max(worst, std::abs(cell - wanted));
        sum += cell;
      }
      EXPECT_LT(worst, 1e-6) << "lambda " << c.lambda << " beta " << c.beta;
      EXPECT_NEAR(sum, 1, 1e-5);
    }
  }
}

TEST(MembraneResponse, CandidatesDoNotMixAndTheOracleResponds) {
  const std::vector<float> cells = response_of(.15, .5, 60, 3, true);
  Volume impulse(kSide, kSide, {0, 0}, Side::kLeft);
  impulse.at(kCentre - 3, kCentre, 0) = 1;
  const Volume expected = plain_membrane(impulse, .15, .5, 60);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    ASSERT_NEAR(cells[i], expected.cells[i], 1e-7);
  }
}

}  // namespace vantage::membrane_response_test
