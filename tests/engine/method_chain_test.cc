// Chains of every method, stage by stage: energies against the plain transcription, and any
// executor against the one that stores every row of every stage.

#include "engine/matching/chain/candidate_geometry.h"
#include "engine/matching/chain/match_chain.h"
#include "scheduler/strip_pipeline.h"
#include "scheduler/whole_image_pipeline.h"
#include "tests/engine/engine_test.h"
#include "tests/engine/method_cases.h"
#include "tests/engine/oracle_comparison.h"

namespace vantage::method_chain_test {

constexpr int kWidth = 57;
constexpr int kHeight = 39;
constexpr DisparityRange kRange{-3, 21};

struct Outputs {
  Image<float> disparity_px{kWidth, kHeight};
  Image<float> confidence{kWidth, kHeight};
  Image<float> energy{kWidth, kHeight};

  [[nodiscard]] MapOutputs views() {
    return {disparity_px.view(), confidence.view(), energy.view()};
  }
  [[nodiscard]] bool equals(const Outputs& other) const {
    return identical(disparity_px, other.disparity_px) && identical(confidence, other.confidence) &&
           identical(energy, other.energy);
  }
};

/// A prepared pair and the chains of one map of it.
class MethodChain : public ::testing::TestWithParam<MethodCase> {
 protected:
  void prepare(Side reference, PixelKind kind) {
    options_ = GetParam().options;
    options_.disparities = kRange;
    parameters_ = options_.resolved();
    photographs_ = textured_pair(kWidth, kHeight, kRange, kind, 9);
    geometry_ = candidate_geometry(options_.in_force(), reference, kWidth, kHeight);
    const bool is_left = reference == Side::kLeft;
    if (uses_column_ssd(parameters_)) {
      pair_.prepare(photographs_.left, photographs_.right, geometry_,
                    parameters_.window_px * parameters_.window_px, {is_left, !is_left}, execution_);
      input_.pair = &pair_;
      return;
    }
    const auto of_left = candidate_geometry(options_.in_force(), Side::kLeft, kWidth, kHeight);
    const auto& [left, right] = photographs_;
    reference_.prepare(is_left ? left : right, parameters_, of_left, {true, false, false},
                       execution_);
    other_.prepare(is_left ? right : left, parameters_, of_left, {false, is_left, !is_left},
                   execution_);
    input_ = {nullptr, &reference_, {CostPartner{&other_}}};
  }

  [[nodiscard]] MatchChain chain(Outputs& outputs) const {
    return {parameters_, geometry_, input_, outputs.views()};
  }

  Execution execution_{{.threads = 2}};
  MatchOptions options_;
  MethodParameters parameters_;
  PhotographPair photographs_;
  kernels::CandidateGeometry geometry_;
  PreparedPair pair_;
  CostImage reference_;
  CostImage other_;
  ChainInput input_;
};

TEST_P(MethodChain, EnergiesEqualTheOracle) {
  if (is_stepped(GetParam()) || GetParam().options.resolved().edge_weight < 1) {
    GTEST_SKIP() << "rounded to steps, or weights that a chain alone has not: see stage_cost_test, "
                    "coarse_to_fine_test, edge_weights_test";
  }
  for (const Side reference : {Side::kLeft, Side::kRight}) {
    prepare(reference, PixelKind::kGreyFloat);
    Outputs outputs;
    scheduler::run_whole_image(chain(outputs).stages());
    const PlainMap oracle =
        plain_match(photographs_.left, photographs_.right, reference, kRange, parameters_);
    const Tolerance tolerance = tolerance_of(parameters_);
    int candidates = 0;
    int equal = 0;
    int close = 0;
    double worst = 0;
    for (const auto [x, y] : positions_of(kWidth, kHeight)) {
      const double expected = oracle.at(x, y).energy;
      ASSERT_EQ(std::isnan(outputs.energy.at(x, y)), std::isnan(expected)) << x << ", " << y;
      candidates += std::isnan(expected) ? 0 : 1;
      if (outputs.disparity_px.at(x, y) == oracle.at(x, y).winner) {
        ++equal;
        const double off = std::abs(outputs.energy.at(x, y) - expected) /
                           std::max(std::abs(expected), tolerance.floor);
        close += off <= tolerance.energy ? 1 : 0;
        worst = std::max(worst, off);
      }
    }
    EXPECT_GE(equal, tolerance.share * candidates - 1);
    EXPECT_GE(close, tolerance.confidence_share * equal - tolerance.strays)
        << "worst, relative: " << worst;
  }
}

TEST_P(MethodChain, EveryExecutorEqualsTheWholeImage) {
  for (const Side reference : {Side::kLeft, Side::kRight}) {
    prepare(reference, PixelKind::kColour8);
    Outputs whole;
    scheduler::run_whole_image(chain(whole).stages());
    for (const int iterations_per_pass : {0, 1, 4}) {
      for (const std::uint64_t seed : {1U, 2U}) {
        Outputs outputs;
        const MatchChain strips = chain(outputs);
        scheduler::PlanRequest request;
        request.threads = 3;
        request.strip_columns = seed == 1 ? 13 : 40;
        request.band_rows = seed == 1 ? 17 : 6;
        if (iterations_per_pass > 0) {
          request.pass_ends = strips.pass_ends(iterations_per_pass);
        }
        const auto plan = scheduler::plan_chain(strips.stages(), execution_.machine(), request);
        const auto shuffled = scheduler::make_shuffled_executor(seed);
        scheduler::run_strips(strips.stages(), plan, *shuffled, execution_.scratch());
        EXPECT_TRUE(outputs.equals(whole))
            << "iterations per pass " << iterations_per_pass << ", seed " << seed;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Methods, MethodChain, ::testing::ValuesIn(method_cases({})),
                         [](const auto& instance) { return instance.param.name; });

}  // namespace vantage::method_chain_test
