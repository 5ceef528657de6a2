// What must not change results: threads, executors, plans, and, within bounds, instruction sets.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>

#include "engine/matching/stereo_matcher.h"
#include "engine/simd.h"
#include "tests/engine/identical_maps.h"
#include "tests/engine/method_cases.h"
#include "tests/engine/oracle_comparison.h"

namespace vantage {
namespace method_execution_test {

using test::identical;
using test::method_cases;
using test::MethodCase;
using test::PhotographPair;
using test::PixelKind;
using test::textured_pair;

DisparityMaps maps_of(const PhotographPair& pair, const MatchOptions& options,
                      const ExecutionOptions& execution_options) {
  Execution execution(execution_options);
  DisparityMaps maps;
  StereoMatcher(options, execution).match(pair.left, pair.right, {.confidence = true}, maps);
  return maps;
}

/// While it exists, Executions plan for the machine that hwloc's `description` stands for.
class SimulatedMachine {
 public:
  explicit SimulatedMachine(const std::string& description) {
    ::setenv(kVariable, description.c_str(), 1);
  }
  SimulatedMachine(const SimulatedMachine&) = delete;
  SimulatedMachine& operator=(const SimulatedMachine&) = delete;
  ~SimulatedMachine() { ::unsetenv(kVariable); }

 private:
  static constexpr const char* kVariable = "HWLOC_SYNTHETIC";
};

class MethodExecution : public ::testing::TestWithParam<MethodCase> {};

TEST_P(MethodExecution, PlansAndExecutorsGiveIdenticalResults) {
  using scheduler::ExecutorKind;
  for (const PixelKind kind : {PixelKind::kGrey8, PixelKind::kColour8}) {
    const auto pair = textured_pair(59, 41, {-3, 17}, kind, 7);
    MatchOptions options = GetParam().options;
    options.disparities = {-3, 17};
    options.parameters.subpixel = Subpixel::kParabola;
    const DisparityMaps expected =
        maps_of(pair, options, {.threads = 1, .executor = ExecutorKind::kSerial});
    const auto expect_identical = [&](const ExecutionOptions& execution, const std::string& what) {
      EXPECT_TRUE(identical(maps_of(pair, options, execution), expected)) << what;
    };
    for (const ExecutorKind executor :
         {ExecutorKind::kTbb, ExecutorKind::kOpenMp, ExecutorKind::kSerial}) {
#ifdef __SANITIZE_THREAD__
      if (executor == ExecutorKind::kOpenMp) {
        continue;  // libgomp is not instrumented
      }
#endif
      for (const int threads : {1, 2, 3}) {
        expect_identical({.threads = threads, .executor = executor},
                         "executor " + std::to_string(static_cast<int>(executor)) + ", threads " +
                             std::to_string(threads));
      }
    }
    for (const ExecutorKind executor : {ExecutorKind::kTbb, ExecutorKind::kOpenMp}) {
#ifdef __SANITIZE_THREAD__
      if (executor == ExecutorKind::kOpenMp) {
        continue;
      }
#endif
      for (const auto binding :
           {scheduler::ThreadBinding::kNodes, scheduler::ThreadBinding::kCores}) {
        expect_identical({.threads = 2, .executor = executor, .binding = binding}, "bound here");
        const SimulatedMachine machine("node:2 core:2 pu:1");
        expect_identical({.threads = 3, .executor = executor, .binding = binding},
                         "on two nodes, as if bound to them");
      }
    }
    for (const int strip : {1, 16, 23, 500}) {
      for (const int band : {1, 9, 500}) {
        for (const int pass : {1, 3, 1000}) {
          if (strip * band < 9 && pass > 1) {
            continue;  // a whole cone of cells for every pixel
          }
          expect_identical({.threads = 2,
                            .strip_width_px = strip,
                            .band_height_px = band,
                            .iterations_per_pass = pass},
                           "strip " + std::to_string(strip) + ", band " + std::to_string(band) +
                               ", iterations per pass " + std::to_string(pass));
        }
      }
    }
  }
}

/// Each instruction set against the first. Bayesian diffusion with sums and entropies use fused
/// operations where there are some: winners, and confidences where winners are equal.
TEST_P(MethodExecution, InstructionSetsAgree) {
  const auto pair = textured_pair(59, 41, {-3, 28}, PixelKind::kGrey8, 8);
  MatchOptions options = GetParam().options;
  options.disparities = {-3, 28};
  const MethodParameters parameters = options.resolved();
  const bool is_fused = (parameters.aggregation == Aggregation::kBayes &&
                         parameters.prior_smoothing == PriorSmoothing::kSum) ||
                        (parameters.aggregation == Aggregation::kLocalStopping &&
                         parameters.certainty == Certainty::kEntropy);
  const ExecutionOptions execution{.threads = 1};
  DisparityMaps expected;
  for (const std::string& name : available_instruction_sets()) {
    force_instruction_set(name);
    ASSERT_EQ(instruction_set_in_use(), name);
    DisparityMaps maps = maps_of(pair, options, execution);
    if (expected.left.empty()) {
      expected = std::move(maps);
      continue;
    }
    if (!is_fused) {
      EXPECT_TRUE(identical(maps, expected)) << name;
      continue;
    }
    int candidates = 0;
    int equal = 0;
    for (int y = 0; y < maps.left.height(); ++y) {
      for (int x = 0; x < maps.left.width(); ++x) {
        const float wanted = expected.left.at(x, y);
        EXPECT_EQ(std::isnan(maps.left.at(x, y)), std::isnan(wanted)) << name;
        candidates += std::isnan(wanted) ? 0 : 1;
        if (maps.left.at(x, y) == wanted) {
          ++equal;
          const float confidence = expected.left_confidence.at(x, y);
          EXPECT_NEAR(maps.left_confidence.at(x, y), confidence,
                      1e-5 * std::max(1.0F, std::abs(confidence)))
              << name << " at " << x << ", " << y;
        }
      }
    }
    EXPECT_GE(equal, 0.999 * candidates) << name;
  }
  force_instruction_set("best");
}

INSTANTIATE_TEST_SUITE_P(Methods, MethodExecution, ::testing::ValuesIn(method_cases({})),
                         [](const auto& instance) { return instance.param.name; });

}  // namespace method_execution_test
}  // namespace vantage
