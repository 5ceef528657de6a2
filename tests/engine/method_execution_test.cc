// What must not change results: threads, executors, plans, and, within bounds, instruction sets.

#include "engine/matching/stereo_matcher.h"
#include "engine/simd.h"
#include "tests/engine/engine_test.h"
#include "tests/engine/method_cases.h"
#include "tests/engine/oracle_comparison.h"
#include "tests/test_sample.h"

namespace vantage::method_execution_test {

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

/// The methods, and what the plain transcription does not know: levels with few candidates,
/// searches in two dimensions, and presets with refined maps, of candidates between pixels.
std::vector<MethodCase> all_methods() {
  std::vector<MethodCase> all = method_cases({});
  const auto add = [&](const char* name, MethodOverrides parameters) -> MatchOptions& {
    all.push_back({name, {}});
    all.back().options.parameters = std::move(parameters);
    return all.back().options;
  };
  MatchOptions& pruned = add("pruned", {.cost = MatchCost::kCensus,
                                        .sigma_measurement = 10,
                                        .iterations = 3,
                                        .levels = 4,
                                        .candidate_blocks = 1,
                                        .epsilon_prior = 5e-5,
                                        .prior_smoothing = PriorSmoothing::kMaximum});
  pruned.method = MatchMethod::kBayes;
  pruned.raw = true;
  for (const MatchMethod method : {MatchMethod::kSsd, MatchMethod::kBayes}) {
    MatchOptions& options = add(method == MatchMethod::kSsd ? "ssd_2d" : "bayes_2d", {});
    options.method = method;
    options.disparities_y = {-2, 1};
  }
  for (const auto& [name, preset] : {std::pair{"realtime", MatchPreset::kRealtime},
                                     std::pair{"balanced", MatchPreset::kBalanced},
                                     std::pair{"quality", MatchPreset::kQuality}}) {
    add(name, {.candidate_step_px = 0.5}).preset = preset;
  }
  return all;
}

const std::vector<MethodCase>& methods() {
  static const std::vector<MethodCase> methods = all_methods();
  return methods;
}

// Dimensions of the sample of ways to match; what is not set the cost model chooses.
constexpr PixelKind kKinds[] = {PixelKind::kGrey8, PixelKind::kColour8};
constexpr scheduler::ExecutorKind kExecutors[] = {scheduler::ExecutorKind::kTbb,
                                                  scheduler::ExecutorKind::kOpenMp,
                                                  scheduler::ExecutorKind::kSerial};
constexpr int kThreads[] = {1, 2, 3};
/// Where threads run: anywhere; bound on this machine; on two nodes, as if bound to them.
struct Place {
  std::optional<scheduler::ThreadBinding> binding;
  bool is_simulated = false;
};
constexpr Place kPlaces[] = {{},
                             {scheduler::ThreadBinding::kNodes},
                             {scheduler::ThreadBinding::kCores},
                             {scheduler::ThreadBinding::kNodes, true},
                             {scheduler::ThreadBinding::kCores, true}};
constexpr std::optional<int> kStrips[] = {1, 16, 23, 500, std::nullopt};
constexpr std::optional<int> kBands[] = {1, 9, 500, std::nullopt};
constexpr std::optional<int> kPasses[] = {1, 3, 1000, std::nullopt};

/// A row: method; pixels; executor; threads; place; strip; band; pass.
const std::vector<SampleRow>& execution_rows() {
  static const auto is_sensible = [](const SampleRow& row) {
#ifdef __SANITIZE_THREAD__
    if (kExecutors[row[2]] == scheduler::ExecutorKind::kOpenMp) {
      return false;  // libgomp is not instrumented
    }
#endif
    if (kExecutors[row[2]] == scheduler::ExecutorKind::kSerial && kPlaces[row[4]].binding) {
      return false;
    }
    // Else a whole cone of cells for every pixel.
    const int cells = kStrips[row[5]].value_or(16) * kBands[row[6]].value_or(9);
    return cells >= 9 || kPasses[row[7]] == 1;
  };
  static const auto rows =
      sampled_rows({static_cast<int>(methods().size()), static_cast<int>(std::size(kKinds)),
                    static_cast<int>(std::size(kExecutors)), static_cast<int>(std::size(kThreads)),
                    static_cast<int>(std::size(kPlaces)), static_cast<int>(std::size(kStrips)),
                    static_cast<int>(std::size(kBands)), static_cast<int>(std::size(kPasses))},
                   is_sensible);
  return rows;
}

class MethodExecution : public ::testing::TestWithParam<int> {
 protected:
  static const MethodCase& method() { return methods()[static_cast<std::size_t>(GetParam())]; }
};

TEST_P(MethodExecution, PlansAndExecutorsGiveIdenticalResults) {
  MatchOptions options = method().options;
  options.disparities = {-3, 17};
  options.parameters.subpixel = Subpixel::kParabola;
  PhotographPair pairs[std::size(kKinds)];
  DisparityMaps expected[std::size(kKinds)];
  for (const SampleRow& row : rows_of(execution_rows(), GetParam())) {
    PhotographPair& pair = pairs[row[1]];
    DisparityMaps& wanted = expected[row[1]];
    if (wanted.left.disparity_px.empty()) {
      pair = textured_pair(59, 41, {-3, 17}, kKinds[row[1]], 7);
      wanted = maps_of(pair, options, {.threads = 1, .executor = scheduler::ExecutorKind::kSerial});
    }
    const Place& place = kPlaces[row[4]];
    std::optional<SimulatedMachine> machine;
    if (place.is_simulated) {
      machine.emplace("node:2 core:2 pu:1");
    }
    const ExecutionOptions execution{.threads = kThreads[row[3]],
                                     .executor = kExecutors[row[2]],
                                     .binding = place.binding,
                                     .strip_width_px = kStrips[row[5]],
                                     .band_height_px = kBands[row[6]],
                                     .iterations_per_pass = kPasses[row[7]]};
    EXPECT_TRUE(identical(maps_of(pair, options, execution), wanted))
        << "pixels, executor, threads, place, strip, band, pass: " << ::testing::PrintToString(row)
        << ", " << sample_name();
  }
}

/// Each instruction set against the first. Bayesian diffusion with sums and entropies use fused
/// operations where there are some: winners, and confidences where winners are equal.
TEST_P(MethodExecution, InstructionSetsAgree) {
  const auto pair = textured_pair(45, 23, {-3, 28}, PixelKind::kGrey8, 8);
  MatchOptions options = method().options;
  if (!options.raw) {
    GTEST_SKIP() << "few winners that differ change the refinement of others";
  }
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
    if (expected.left.disparity_px.empty()) {
      expected = std::move(maps);
      continue;
    }
    if (!is_fused) {
      EXPECT_TRUE(identical(maps, expected)) << name;
      continue;
    }
    int candidates = 0;
    int equal = 0;
    for (const auto [x, y] : positions_of(maps.left.disparity_px)) {
      const float wanted = expected.left.disparity_px.at(x, y);
      EXPECT_EQ(std::isnan(maps.left.disparity_px.at(x, y)), std::isnan(wanted)) << name;
      candidates += std::isnan(wanted) ? 0 : 1;
      if (maps.left.disparity_px.at(x, y) == wanted) {
        ++equal;
        const float confidence = expected.left.confidence.at(x, y);
        EXPECT_NEAR(maps.left.confidence.at(x, y), confidence,
                    1e-5 * std::max(1.0F, std::abs(confidence)))
            << name << " at " << x << ", " << y;
      }
    }
    EXPECT_GE(equal, 0.999 * candidates) << name;
  }
  force_instruction_set("best");
}

INSTANTIATE_TEST_SUITE_P(Methods, MethodExecution,
                         ::testing::Range(0, static_cast<int>(methods().size())),
                         [](const auto& instance) {
                           return methods()[static_cast<std::size_t>(instance.param)].name;
                         });

}  // namespace vantage::method_execution_test
