// Levels on which few candidates are looked at, against levels that look at all, and what whole
// pruned runs must not depend on.

#include "engine/matching/aggregation/edge_weights.h"
#include "engine/matching/aggregation/stage_max_product.h"
#include "engine/matching/levels/candidate_blocks.h"
#include "engine/matching/levels/stage_block_source.h"
#include "engine/matching/levels/stage_fixed_energies.h"
#include "engine/matching/options/method_rules.h"
#include "engine/matching/selection/stage_fixed_energy_selection.h"
#include "engine/matching/stereo_matcher.h"
#include "kernels/compact_likelihoods/compact_likelihoods.h"
#include "tests/engine/cell_stages.h"
#include "tests/engine/engine_test.h"
#include "tests/engine/oracle_comparison.h"
#include "tests/test_sample.h"

namespace vantage::pruned_levels_test {

using kernels::CandidateGeometry;
using kernels::FixedEnergy;
using scheduler::Extent;
using Energies = CellVolume<FixedEnergy>;

constexpr Extent kExtent{41, 19};

/// A level between two others: its energies, the coarser level's probabilities, and blocks.
struct Level {
  CandidateGeometry geometry;
  LevelVolume energies;
  LevelVolume coarser;
  CandidateBlocks blocks;

  /// `everywhere`: winners lie in all blocks, around every tile.
  Level(int candidates, int max, bool everywhere)
      : geometry{.width = kExtent.columns, .disparity_min = 0, .count = candidates} {
    std::mt19937 random(static_cast<unsigned>(candidates));
    const Extent coarse{(kExtent.columns + 1) / 2, (kExtent.rows + 1) / 2};
    energies.resize(kExtent, geometry.lanes(), 1);
    coarser.resize(coarse, geometry.lanes(), 1);
    for (LevelVolume* volume : {&energies, &coarser}) {
      for (int y = 0; y < volume->extent().rows; ++y) {
        auto* cells = volume->column<std::uint8_t>(0, y);
        for (int k = 0; k < volume->extent().columns * geometry.lanes(); ++k) {
          cells[k] = static_cast<std::uint8_t>(random() % 60);
        }
      }
    }
    const int block_count = geometry.lanes() / kernels::kLaneMultiple;
    Image<std::int32_t> winners(coarse.columns, coarse.rows);
    for (const auto [x, y] : positions_of(coarse.columns, coarse.rows)) {
      const int block = everywhere ? x + 2 * y : x / 8 + y / 4 + static_cast<int>(random() % 5) / 2;
      winners.at(x, y) = std::min(block % block_count * kernels::kLaneMultiple + 8, candidates - 1);
    }
    blocks.resize(kExtent, candidates, max);
    blocks.choose(winners.view(), std::nullopt, execution());
  }

  /// Takes what the coarser level says of candidates that are not looked at for impossible; one
  /// that is looked at was its winner.
  void mask_coarser() {
    for (const auto [x, y] : positions_of(coarser.extent().columns, coarser.extent().rows)) {
      const BlockList list = blocks.at(2 * x, 2 * y);
      for (int lane = 0; lane < geometry.lanes(); ++lane) {
        if (std::ranges::find(list, lane / 16) == list.end()) {
          coarser.column<std::uint8_t>(x, y)[lane] = kernels::kMaxCompact;
        }
      }
      coarser.column<std::uint8_t>(x, y)[candidate_of(list, 1)] = 0;
    }
  }
};

MethodParameters bayes_parameters(double sigma_prior, double mu) {
  MethodOverrides overrides;
  overrides.iterations = 3;
  overrides.sigma_prior = sigma_prior;
  overrides.mu = mu;
  overrides.edge_weight = 0.2;
  overrides.prior_smoothing = PriorSmoothing::kMaximum;
  return resolve(MatchMethod::kBayes, overrides);
}

constexpr const EdgeWeights* kNoEdges = nullptr;
constexpr const CandidateBlocks* kAllBlocks = nullptr;

EdgeWeights random_edges(const MethodParameters& parameters) {
  std::mt19937 random(3);
  Image<float> grey(kExtent.columns, kExtent.rows);
  for (int y = 0; y < kExtent.rows; ++y) {
    std::generate_n(grey.row(y), kExtent.columns,
                    [&] { return static_cast<float>(random() % 30); });
  }
  EdgeWeights edges;
  edges.prepare(grey.view(), parameters, execution());
  return edges;
}

/// Keeps the cells of the last stage, in all lanes that `blocks` has.
class BlockSink final : public scheduler::RowStage {
 public:
  BlockSink(Energies& volume, const CandidateBlocks* blocks, int lanes)
      : RowStage(volume.extent), volume_(volume), blocks_(blocks), lanes_(lanes) {}
  [[nodiscard]] std::string_view name() const override { return "block sink"; }
  [[nodiscard]] std::size_t bytes_per_column() const override { return 0; }
  void make_row(const scheduler::RowTask& task) const override {
    for (int x = task.columns.begin; x < task.columns.end; ++x) {
      const FixedEnergy* cells =
          task.input.row<FixedEnergy>(task.y) +
          static_cast<std::ptrdiff_t>(x - task.input.columns().begin) * lanes_;
      for (int lane = 0; lane < volume_.lanes; ++lane) {
        if (blocks_ == nullptr) {
          volume_.at(x, task.y, lane) = cells[lane];
        }
      }
      if (blocks_ != nullptr) {
        const BlockList list = blocks_->at(x, task.y);
        for (int lane = 0; lane < 16 * static_cast<int>(list.size()); ++lane) {
          volume_.at(x, task.y, candidate_of(list, lane)) = cells[lane];
        }
      }
    }
  }

 private:
  Energies& volume_;
  const CandidateBlocks* blocks_;
  int lanes_;
};

/// Makes candidates that are not looked at impossible.
class MaskedSource final : public scheduler::RowStage {
 public:
  MaskedSource(std::unique_ptr<scheduler::RowStage> inner, const CandidateBlocks& blocks, int lanes)
      : RowStage(inner->extent()), inner_(std::move(inner)), blocks_(blocks), lanes_(lanes) {}
  [[nodiscard]] std::string_view name() const override { return "masked source"; }
  [[nodiscard]] std::size_t bytes_per_column() const override { return inner_->bytes_per_column(); }
  void make_row(const scheduler::RowTask& task) const override {
    inner_->make_row(task);
    auto* cells = reinterpret_cast<FixedEnergy*>(task.output);
    for (int x = task.columns.begin; x < task.columns.end; ++x, cells += lanes_) {
      const BlockList list = blocks_.at(x, task.y);
      for (int lane = 0; lane < lanes_; ++lane) {
        if (std::ranges::find(list, lane / 16) == list.end()) {
          cells[lane] = kernels::kMaxEnergy;
        }
      }
    }
  }

 private:
  std::unique_ptr<scheduler::RowStage> inner_;
  const CandidateBlocks& blocks_;
  int lanes_;
};

/// What a level ends with, all candidates of it; pruned, or as if all were looked at but those
/// not in blocks were impossible. Where nothing is looked at, pruned cells are impossible.
Energies cells_of(const Level& level, const MethodParameters& parameters, bool pruned,
                  const EdgeWeights* edges = nullptr, bool every_way = false) {
  Energies result(kExtent, level.geometry.lanes());
  std::ranges::fill(result.cells, kernels::kMaxEnergy);
  const CandidateBlocks* const blocks = pruned ? &level.blocks : nullptr;
  std::vector<std::unique_ptr<scheduler::RowStage>> stages;
  stages.push_back(make_level_fixed_energy_stage(level.geometry, level.energies,
                                                 EnergyFormat(parameters), blocks));
  if (!pruned) {
    stages.back() = std::make_unique<MaskedSource>(std::move(stages.back()), level.blocks,
                                                   level.geometry.lanes());
  }
  for (auto& stage : make_max_product_stages(parameters, {.geometry = level.geometry,
                                                         .height = kExtent.rows,
                                                         .edges = edges,
                                                         .coarser = &level.coarser,
                                                         .blocks = blocks})) {
    stages.push_back(std::move(stage));
  }
  stages.push_back(std::make_unique<BlockSink>(
      result, blocks, pruned ? level.blocks.lanes() : level.geometry.lanes()));
  std::vector<const scheduler::RowStage*> chain;
  for (const auto& stage : stages) {
    chain.push_back(stage.get());
  }
  scheduler::run_whole_image(chain);
  if (every_way) {
    const Energies expected = result;
    run_in_strips(chain, [&] { ASSERT_EQ(result.cells, expected.cells); });
  }
  return result;
}

/// With a prior that does not reach from one candidate to the next, what is not looked at is the
/// same as what is impossible.
TEST(PrunedLevel, EqualsALevelWhereTheOthersAreImpossible) {
  for (const int candidates : {5, 40, 100, 200}) {
    for (const double mu : {0.5, 0.7}) {
      Level level(candidates, 3, false);
      level.mask_coarser();
      const MethodParameters parameters = bayes_parameters(0.1, mu);
      const EdgeWeights edges = random_edges(parameters);
      for (const EdgeWeights* const weights : {kNoEdges, &edges}) {
        const auto pruned = cells_of(level, parameters, true, weights);
        const auto masked = cells_of(level, parameters, false, weights);
        for (const auto [x, y] : positions_of(kExtent.columns, kExtent.rows)) {
          const BlockList list = level.blocks.at(x, y);
          for (int lane = 0; lane < level.blocks.count(list); ++lane) {
            const int candidate = candidate_of(list, lane);
            ASSERT_EQ(pruned.at(x, y, candidate), masked.at(x, y, candidate))
                << candidates << " candidates, mu " << mu << ", " << candidate << " of " << x
                << ", " << y;
          }
        }
      }
    }
  }
}

TEST(PrunedLevel, DoesNotDependOnHowItIsCut) {
  const Level level(100, 3, false);
  const MethodParameters parameters = bayes_parameters(0.4, 0.5);
  const EdgeWeights edges = random_edges(parameters);
  for (const EdgeWeights* const weights : {kNoEdges, &edges}) {
    cells_of(level, parameters, true, weights, true);
  }
}

/// Where all blocks are looked at, bit for bit the same.
TEST(PrunedLevel, WithAllCandidatesIsTheFullLevel) {
  for (const int candidates : {3, 16, 30, 61}) {
    const Level level(candidates, 8, true);
    ASSERT_EQ(level.blocks.cells(),
              static_cast<double>(kExtent.columns) * kExtent.rows * candidates);
    for (const double sigma_prior : {0.1, 0.4, 2.0}) {
      for (const double mu : {0.5, 0.7}) {
        const MethodParameters parameters = bayes_parameters(sigma_prior, mu);
        const EdgeWeights edges = random_edges(parameters);
        for (const EdgeWeights* const weights : {kNoEdges, &edges}) {
          EXPECT_EQ(cells_of(level, parameters, true, weights).cells,
                    cells_of(level, parameters, false, weights).cells)
              << candidates << " candidates";
        }
      }
    }
  }
}

MatchOptions pruned_options(DisparityRange range, int blocks) {
  MatchOptions options;
  options.method = MatchMethod::kBayes;
  options.disparities = range;
  options.parameters.cost = MatchCost::kCensus;
  options.parameters.sigma_measurement = 10;
  options.parameters.sigma_prior = 0.4;
  options.parameters.epsilon_prior = 5e-5;
  options.parameters.iterations = 3;
  options.parameters.levels = 4;
  options.parameters.candidate_blocks = blocks;
  options.parameters.prior_smoothing = PriorSmoothing::kMaximum;
  options.raw = true;
  return options;
}

TEST(PrunedMatching, SixteenCandidatesIsFullMatching) {
  for (const Extent extent : {Extent{1, 1}, Extent{1, 7}, Extent{13, 11}, Extent{70, 37}}) {
    const DisparityRange range{0, std::min(15, extent.columns - 1)};
    const auto pair = textured_pair(extent.columns, extent.rows, range, PixelKind::kGrey8, 3);
    EXPECT_TRUE(identical(maps_of(pair, pruned_options(range, 1)),
                          maps_of(pair, pruned_options(range, 0))));
  }
}

TEST(PrunedMatching, WiderRangesThanImagesHasADisparityEverywhere) {
  for (const Extent extent : {Extent{1, 1}, Extent{5, 3}, Extent{33, 17}}) {
    const auto pair = textured_pair(extent.columns, extent.rows, {0, 3}, PixelKind::kGrey8, 3);
    const DisparityMaps maps = maps_of(pair, pruned_options({-90, 120}, 1));
    for (const auto [x, y] : positions_of(extent.columns, extent.rows)) {
      EXPECT_FALSE(std::isnan(maps.left.disparity_px.at(x, y)));
      EXPECT_FALSE(std::isnan(maps.right.disparity_px.at(x, y)));
    }
  }
}

/// A bar 3 pixels wide far in front of a background.
TEST(PrunedMatching, ThinObjectsStayFound) {
  constexpr int kWidth = 220;
  constexpr int kHeight = 60;
  constexpr int kBar = 71;
  constexpr int kBackground = 9;
  std::mt19937 random(7);
  const auto grey = [&] { return static_cast<std::uint8_t>(random() % 200 + 20); };
  Image<std::uint8_t> left(kWidth, kHeight);
  Image<std::uint8_t> right(kWidth, kHeight);
  std::vector<std::uint8_t> world(kWidth + kBackground);
  for (int y = 0; y < kHeight; ++y) {
    std::generate(world.begin(), world.end(), grey);
    for (int x = 0; x < kWidth; ++x) {
      left.at(x, y) = world[static_cast<std::size_t>(x)];
      right.at(x, y) = world[static_cast<std::size_t>(x + kBackground)];
    }
    for (int x = 150; x < 153; ++x) {
      left.at(x, y) = right.at(x - kBar, y) = grey();
    }
  }
  const PhotographPair pair{Photograph{std::move(left)}, Photograph{std::move(right)}};
  MatchReport full_report;
  MatchReport pruned_report;
  MatchOptions options = pruned_options({0, 127}, 0);
  options.parameters.cost = MatchCost::kContaminated;
  options.parameters.sigma_measurement = 5;
  options.parameters.epsilon_measurement = 1e-3;
  options.parameters.epsilon_prior = 0.01;
  const DisparityMaps full =
      maps_of(pair, options, {.threads = 2}, {.confidence = true}, &full_report);
  // On level 2 the bar is less than a pixel wide: level 1 must look for itself.
  options.parameters.candidate_blocks = 2;
  options.parameters.pruned_levels = 1;
  const DisparityMaps pruned =
      maps_of(pair, options, {.threads = 2}, {.confidence = true}, &pruned_report);
  int found = 0;
  int full_found = 0;
  int different = 0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 150; x < 153; ++x) {
      found += std::abs(pruned.left.disparity_px.at(x, y) - kBar) < 1 ? 1 : 0;
      full_found += std::abs(full.left.disparity_px.at(x, y) - kBar) < 1 ? 1 : 0;
    }
    for (int x = 127; x < kWidth; ++x) {
      different +=
          std::abs(pruned.left.disparity_px.at(x, y) - full.left.disparity_px.at(x, y)) > 1 ? 1 : 0;
    }
  }
  EXPECT_GE(full_found, 3 * kHeight * 9 / 10) << "nothing to lose";
  EXPECT_GE(found, full_found * 99 / 100);
  EXPECT_LE(different, (kWidth - 127) * kHeight / 100);
  EXPECT_EQ(full_report.finest_cells, full_report.finest_pixels * 128);
  EXPECT_LT(pruned_report.finest_cells, full_report.finest_cells / 4);
  EXPECT_LT(pruned_report.cells, full_report.cells / 2);
}

TEST(PrunedMatching, IsRefusedWhereItHasNoMeaning) {
  const auto message = [](const MethodOverrides& change) {
    MatchOptions options = pruned_options({0, 63}, 2);
    options.parameters = merge(options.parameters, change);
    return error_of([&] { validate(options.resolved()); });
  };
  EXPECT_EQ(message({}), "");
  EXPECT_EQ(message({.candidate_blocks = 9}),
            "candidate-blocks is 9, expected a number from 0 (all candidates) to 8");
  EXPECT_EQ(message({.pruned_levels = 0}), "pruned-levels is 0, expected a number from 1 to 10");
  EXPECT_EQ(message({.levels = 1}),
            "candidate-blocks is 2, expected 0 with a single level: candidates are chosen by the "
            "winners of a coarser level");
  EXPECT_EQ(message({.aggregation = Aggregation::kMembrane}),
            "candidate-blocks is 2, expected 0 unless aggregation is bayes: for energies, "
            "candidates that were not searched have no value that is neutral to their neighbours");
  EXPECT_EQ(message({.cost = MatchCost::kGradient}),
            "candidate-blocks is 2, expected 0 with the cost gradient: its likelihoods compare a "
            "candidate with the best of all");
  EXPECT_EQ(message({.prior_smoothing = PriorSmoothing::kSum}),
            "candidate-blocks is 2, expected 0 with prior-smoothing sum: pruning needs "
            "prior-smoothing maximum");
}

TEST(PrunedMatching, OfAPresetIsDroppedWithSums) {
  MatchOptions options;
  options.preset = MatchPreset::kBalanced;
  EXPECT_GT(options.resolved().candidate_blocks, 0);
  options.parameters.prior_smoothing = PriorSmoothing::kSum;
  EXPECT_EQ(options.resolved().candidate_blocks, 0);
  options.validate();
}

}  // namespace vantage::pruned_levels_test
