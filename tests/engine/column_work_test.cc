// What stages tell profiles about their work.

#include "engine/matching/chain/candidate_geometry.h"
#include "engine/matching/chain/match_chain.h"
#include "engine/matching/levels/level_stages.h"
#include "tests/engine/engine_test.h"
#include "tests/engine/method_cases.h"
#include "tests/engine/oracle_comparison.h"

namespace vantage::column_work_test {

using scheduler::ColumnWork;

constexpr int kWidth = 57;
constexpr int kHeight = 39;
constexpr DisparityRange kRange{-3, 33};  // 37 candidates in 48 lanes
constexpr int kCandidates = 37;

/// What a chain is made of.
struct ChainCase {
  PixelKind pixels = PixelKind::kGrey8;
  bool has_prior = false;
  std::vector<double> baseline_ratios = {1};
  bool wants_all_outputs = true;
  ChainLevel level = {};
};

/// The work of each stage, first to last, and the bytes of its output columns.
struct StageWork {
  std::string name;
  ColumnWork work;
  std::size_t output_bytes = 0;
};

std::vector<StageWork> works_of(const MatchOptions& method, const ChainCase& made) {
  MatchOptions options = method;
  options.disparities = kRange;
  const MethodParameters parameters = options.resolved();
  const auto photographs = textured_pair(kWidth, kHeight, kRange, made.pixels, 3);
  const auto geometry = candidate_geometry(options.in_force(), Side::kLeft, kWidth, kHeight);
  PreparedPair pair;
  CostImage reference;
  CostImage partner;
  Image<float> prior(kWidth, kHeight);
  ChainInput input;
  const bool is_plain = !made.has_prior && made.baseline_ratios.size() == 1;
  if (is_plain && uses_column_ssd(parameters)) {
    pair.prepare(photographs.left, photographs.right, geometry,
                 parameters.window_px * parameters.window_px, {true, false}, execution());
    input.pair = &pair;
  } else {
    reference.prepare(photographs.left, parameters, geometry, {true, false, false}, execution());
    partner.prepare(photographs.right, parameters, geometry, {false, true, true}, execution());
    input.reference = &reference;
    for (const double ratio : made.baseline_ratios) {
      input.partners.push_back({&partner, ratio});
    }
    if (made.has_prior) {
      input.prior_px = prior.view();
      input.prior_weight = 1;
    }
  }
  std::array<Image<float>, 2> maps;
  for (Image<float>& map : maps) {
    map = Image<float>(kWidth, kHeight);
  }
  MapOutputs outputs{maps[0].view()};
  if (made.wants_all_outputs) {
    outputs.confidence = maps[1].view();
  }
  const MatchChain chain(parameters, geometry, input, outputs, made.level);
  std::vector<StageWork> works;
  for (const scheduler::RowStage* stage : chain.stages()) {
    works.push_back({std::string(stage->name()), stage->column_work(), stage->bytes_per_column()});
  }
  return works;
}

MatchOptions method_named(const std::string& name) {
  for (const MethodCase& method : method_cases(kRange)) {
    if (method.name == name) {
      return method.options;
    }
  }
  ADD_FAILURE() << "no method " << name;
  return {};
}

TEST(ColumnWork, EveryStageKnowsItsOwn) {
  for (const MethodCase& method : method_cases({})) {
    SCOPED_TRACE(method.name);
    std::size_t input_bytes = 0;
    for (const StageWork& stage : works_of(method.options, {})) {
      EXPECT_EQ(stage.work.cells, kCandidates) << stage.name;
      EXPECT_GE(stage.work.operations, kCandidates) << stage.name;
      // The powers of the sum over a quadratic prior are the most.
      EXPECT_LE(stage.work.operations, 450 * kCandidates) << stage.name;
      // Cells are loaded once and stored once at least; certainties behind them in part only.
      const double cell_bytes = 64;
      EXPECT_GE(stage.work.bytes,
                static_cast<double>(input_bytes + stage.output_bytes) - cell_bytes)
          << stage.name;
      input_bytes = stage.output_bytes;
    }
  }
}

TEST(ColumnWork, StagesOfLevelsKnowTheirs) {
  const int lanes = 48;
  for (const char* name : {"bayes_levels", "membrane_levels", "diffusion_levels", "box_levels"}) {
    const MatchOptions method = method_named(name);
    const int cell_bytes = method.method == MatchMethod::kBayes ? 1 : 2;
    // As if the level were as large as the image: what it does to a column is the same.
    LevelVolume costs;
    LevelVolume coarser;
    LevelVolume result;
    costs.resize({kWidth, kHeight}, lanes, cell_bytes);
    coarser.resize(coarser_extent({kWidth, kHeight}), lanes, cell_bytes);
    result.resize({kWidth, kHeight}, lanes, cell_bytes);
    const auto stored = static_cast<double>(lanes * cell_bytes);
    std::vector<std::string> names;
    for (const ChainLevel& level :
         {ChainLevel{.reduced = &coarser}, ChainLevel{.coarser = &coarser},
          ChainLevel{.costs = &costs, .coarser = &coarser, .result = &result}}) {
      for (const StageWork& stage : works_of(method, {.level = level})) {
        EXPECT_EQ(stage.work.cells, kCandidates) << stage.name;
        EXPECT_GE(stage.work.operations, kCandidates) << stage.name;
        EXPECT_LE(stage.work.operations, 300 * kCandidates) << stage.name;
        // A result is selected, or stored.
        const double output_bytes = static_cast<double>(stage.output_bytes);
        EXPECT_GE(stage.work.bytes, output_bytes > 0 ? output_bytes : stored) << stage.name;
        names.push_back(stage.name);
      }
    }
    EXPECT_THAT(names, ::testing::IsSupersetOf({"cost", "reduce", "stored level", "store level"}))
        << name;
  }
}

TEST(ColumnWork, OfIterationsIsThatOfTheirEquations) {
  // (6.7): three additions of neighbours, two products, one addition; (6.9): one of either more.
  for (const auto& [name, operations, cells] :
       {std::tuple{"diffusion", 6, 6}, {"membrane", 8, 7}}) {
    const std::vector<StageWork> works = works_of(method_named(name), {});
    const ColumnWork& iteration = works.at(1).work;
    EXPECT_EQ(iteration.operations, operations * kCandidates) << name;
    EXPECT_EQ(iteration.bytes, 4.0 * cells * 48) << name;
  }
}

TEST(ColumnWork, GrowsWithWhatIsAskedFor) {
  const MatchOptions census = method_named("census_box");
  const auto cost_operations = [&](const ChainCase& made) {
    return works_of(census, made).front().work.operations;
  };
  EXPECT_GT(cost_operations({.baseline_ratios = {1, -1}}), 2 * cost_operations({}));
  EXPECT_GT(cost_operations({.has_prior = true}), cost_operations({}));
  MatchOptions ssd = method_named("ssd");
  const auto selection_operations = [&](const MatchOptions& options, const ChainCase& made) {
    return works_of(options, made).back().work.operations;
  };
  const double min = selection_operations(ssd, {.wants_all_outputs = false});
  EXPECT_GT(selection_operations(ssd, {}), min);
  ssd.parameters.subpixel = Subpixel::kParabola;
  EXPECT_GT(selection_operations(ssd, {.wants_all_outputs = false}), min);
  // Running sums: the window does not matter.
  ssd.parameters.subpixel = Subpixel::kNone;
  ssd.parameters.window_px = 3;
  EXPECT_EQ(selection_operations(ssd, {.wants_all_outputs = false}), min);
  MatchOptions bayes = method_named("bayes");
  const auto iteration_operations = [&](double sigma_prior) {
    bayes.parameters.sigma_prior = sigma_prior;
    return works_of(bayes, {}).at(2).work.operations;
  };
  EXPECT_GT(iteration_operations(0.4), iteration_operations(0.1));
}

}  // namespace vantage::column_work_test
