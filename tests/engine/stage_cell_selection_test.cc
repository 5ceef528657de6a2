#include "engine/matching/selection/stage_cell_selection.h"

#include "engine/image/image.h"
#include "scheduler/whole_image_pipeline.h"
#include "tests/engine/cell_stages.h"
#include "tests/engine/engine_test.h"
#include "tests/engine/plain_column.h"
#include "tests/kernels/cell_winner_rows.h"

namespace vantage::stage_cell_selection_test {

using kernels::CellKind;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

/// The maps of one run.
struct Maps {
  Image<float> disparity_px;
  Image<float> confidence;
  Image<float> energy;

  explicit Maps(scheduler::Extent extent)
      : disparity_px(extent.columns, extent.rows),
        confidence(extent.columns, extent.rows),
        energy(extent.columns, extent.rows) {
    spoil();
  }
  void spoil() {
    for (Image<float>* map : {&disparity_px, &confidence, &energy}) {
      map->fill(-4321.0F);
    }
  }
  [[nodiscard]] MapOutputs outputs() {
    return {disparity_px.view(), confidence.view(), energy.view()};
  }
  [[nodiscard]] std::vector<std::uint32_t> bits() const {
    std::vector<std::uint32_t> bits;
    for (const Image<float>* map : {&disparity_px, &confidence, &energy}) {
      for (const auto [x, y] : positions_of(*map)) {
        bits.push_back(std::bit_cast<std::uint32_t>(map->at(x, y)));
      }
    }
    return bits;
  }
};

/// Cells of an image and how winners are to be chosen from them.
struct Scene {
  kernels::CandidateGeometry geometry;
  CellSelectionSettings settings;
  CellVolume<float> cells;

  [[nodiscard]] bool counts(int x, int i) const {
    const int disparity_px = geometry.disparity_min + i;
    const int partner = geometry.direction < 0 ? x - disparity_px : x + disparity_px;
    return i < geometry.count && partner >= 0 && partner < geometry.width;
  }
  [[nodiscard]] PlainColumn column(int x, int y) const {
    std::vector<double> energies;
    for (int i = 0; i < geometry.count; ++i) {
      const double cell = counts(x, i) ? cells.at(x, y, i) : kNaN;
      energies.push_back(settings.cells_are_probabilities ? -std::log(cell) : cell);
    }
    return PlainColumn(energies);
  }
};

void PrintTo(const Scene& scene, std::ostream* out) {
  const auto& g = scene.geometry;
  *out << g.width << "x" << scene.cells.extent.rows << ", disparities from " << g.disparity_min
       << ", " << g.count << " of them, direction " << g.direction << ", confidence "
       << static_cast<int>(scene.settings.confidence);
}

Scene random_scene(std::mt19937& random, int width, int disparity_min, int count, int direction) {
  const int rows = kernels::random_int(random, 1, 6);
  Scene scene{
      {width, disparity_min, count, direction}, {}, {{width, rows}, (count + 15) / 16 * 16}};
  scene.settings.subpixel = random() % 3 == 0 ? Subpixel::kNone : Subpixel::kParabola;
  scene.settings.entropy_scale = 0.05F;
  const ConfidenceMeasure measures[] = {ConfidenceMeasure::kMargin, ConfidenceMeasure::kEntropy,
                                        ConfidenceMeasure::kEvidence,
                                        ConfidenceMeasure::kProbability};
  scene.settings.confidence = measures[random() % std::size(measures)];
  scene.settings.cells_are_probabilities =
      scene.settings.confidence == ConfidenceMeasure::kProbability;
  const CellKind kind = scene.settings.cells_are_probabilities
                            ? CellKind::kProbability
                            : kernels::kEnergyKinds[random() % std::size(kernels::kEnergyKinds)];
  const float best = scene.settings.cells_are_probabilities ? 2.0F : -1e30F;
  for (const auto [x, y] : positions_of(width, rows)) {
    for (int i = 0; i < scene.cells.lanes; ++i) {
      scene.cells.at(x, y, i) = scene.counts(x, i) ? kernels::random_cell(random, kind) : best;
    }
  }
  return scene;
}

double expected_confidence(const Scene& scene, const PlainColumn& column) {
  switch (scene.settings.confidence) {
    case ConfidenceMeasure::kMargin:
      return column.margin();
    case ConfidenceMeasure::kEntropy:
      return column.entropy(scene.settings.entropy_scale);
    case ConfidenceMeasure::kProbability:
      return std::exp(-column.min());
    case ConfidenceMeasure::kEvidence:
      break;
  }
  return -column.min();
}

void expect_near(float actual, double expected, double tolerance, const char* what) {
  if (std::isinf(expected)) {
    ASSERT_EQ(actual, expected) << what;
  } else {
    ASSERT_NEAR(actual, expected, tolerance * (1 + std::abs(expected))) << what;
  }
}

void expect_plain_selection(const Scene& scene, const Maps& maps) {
  const double min_disparity = scene.geometry.disparity_min;
  for (const auto [x, y] : positions_of(maps.energy)) {
    SCOPED_TRACE(::testing::Message() << "at " << x << ", " << y);
    const PlainColumn column = scene.column(x, y);
    const float actual[] = {maps.disparity_px.at(x, y), maps.confidence.at(x, y),
                            maps.energy.at(x, y)};
    if (!column.has_candidate()) {
      ASSERT_TRUE(std::isnan(actual[0]) && std::isnan(actual[1]) && std::isnan(actual[2]));
      continue;
    }
    const bool parabola = scene.settings.subpixel == Subpixel::kParabola;
    const double index = parabola ? column.refined_winner() : column.winner();
    ASSERT_NO_FATAL_FAILURE(
        expect_near(actual[0], min_disparity + index, parabola ? 1e-6 : 0, "disparity"));
    const bool entropy = scene.settings.confidence == ConfidenceMeasure::kEntropy;
    ASSERT_NO_FATAL_FAILURE(expect_near(actual[1], expected_confidence(scene, column),
                                        entropy ? 1e-5 : 2e-6, "confidence"));
    ASSERT_NO_FATAL_FAILURE(expect_near(
        actual[2], column.min(), scene.settings.cells_are_probabilities ? 1e-6 : 0, "energy"));
  }
}

/// The plain executor against double arithmetic, and all others against the plain one.
void expect_right_every_way(const Scene& scene) {
  SCOPED_TRACE(::testing::PrintToString(scene));
  Maps maps(scene.cells.extent);
  const CellSource source(scene.cells);
  const auto stage = make_cell_selection_stage(scene.geometry, scene.settings, maps.outputs());
  const scheduler::Supervised selection(*stage, scene.cells.extent);
  const scheduler::RowStage* chain[] = {&source, &selection};
  scheduler::run_whole_image(chain);
  ASSERT_NO_FATAL_FAILURE(expect_plain_selection(scene, maps));
  const std::vector<std::uint32_t> expected = maps.bits();
  maps.spoil();
  run_in_strips(chain, [&] {
    ASSERT_EQ(maps.bits(), expected);
    maps.spoil();
  });
}

TEST(CellSelection, EqualsPlainArithmeticOnEveryWidth) {
  std::mt19937 random(71);
  for (int width = 1; width <= 40; ++width) {
    for (const int direction : {-1, 1}) {
      const int count = kernels::random_int(random, 1, 70);
      const int disparity_min = kernels::random_int(random, -width - 20, width + 2);
      ASSERT_NO_FATAL_FAILURE(
          expect_right_every_way(random_scene(random, width, disparity_min, count, direction)));
    }
  }
}

TEST(CellSelection, EqualsPlainArithmeticOnAwkwardRanges) {
  std::mt19937 random(72);
  const struct {
    int width;
    int disparity_min;
    int count;
  } shapes[] = {{1, 0, 1},    {1, -3, 7},    {97, 0, 16},   {97, 0, 17},
                {61, 0, 64},  {33, -40, 74}, {47, -30, 29}, {33, 3, 38},
                {20, 40, 21}, {131, -5, 76}, {64, 0, 65},   {150, -64, 129}};
  for (const auto& shape : shapes) {
    for (const int direction : {-1, 1}) {
      for (int repetition = 0; repetition < 4; ++repetition) {
        ASSERT_NO_FATAL_FAILURE(expect_right_every_way(
            random_scene(random, shape.width, shape.disparity_min, shape.count, direction)));
      }
    }
  }
}

TEST(CellSelection, IsSureOfNothingWhereAllIsEqual) {
  for (const float energy : {0.0F, 3.0F}) {
    Scene scene{{50, 0, 20, -1}, {}, {{50, 2}, 32}};
    scene.cells.cells.assign(scene.cells.cells.size(), energy);
    Maps maps(scene.cells.extent);
    const CellSource source(scene.cells);
    const auto run = [&] {
      const auto stage = make_cell_selection_stage(scene.geometry, scene.settings, maps.outputs());
      const scheduler::RowStage* chain[] = {&source, stage.get()};
      scheduler::run_whole_image(chain);
    };
    run();
    EXPECT_EQ(maps.confidence.at(49, 1), 0);
    EXPECT_EQ(maps.disparity_px.at(49, 1), 0);
    EXPECT_EQ(maps.confidence.at(0, 0), 0);  // a single candidate
    scene.settings.confidence = ConfidenceMeasure::kEntropy;
    run();
    EXPECT_NEAR(maps.confidence.at(49, 1), -std::log(20), 1e-5);
    EXPECT_EQ(maps.confidence.at(0, 0), 0);
  }
}

TEST(CellSelection, MapsThatAreNotWantedChangeNothing) {
  std::mt19937 random(73);
  for (int repetition = 0; repetition < 8; ++repetition) {
    const Scene scene = random_scene(random, 70, -3, 40, -1);
    Maps all(scene.cells.extent);
    Maps some(scene.cells.extent);
    const CellSource source(scene.cells);
    const auto run = [&](const MapOutputs& outputs) {
      const auto stage = make_cell_selection_stage(scene.geometry, scene.settings, outputs);
      const scheduler::RowStage* chain[] = {&source, stage.get()};
      scheduler::run_whole_image(chain);
    };
    run(all.outputs());
    run({.disparity_px = some.disparity_px.view()});
    run({.disparity_px = some.disparity_px.view(), .confidence = some.confidence.view()});
    run({.disparity_px = some.disparity_px.view(), .energy = some.energy.view()});
    ASSERT_EQ(all.bits(), some.bits());
  }
}

TEST(CellSelection, RefusesAConfidenceThatTheCellsDoNotHave) {
  Maps maps({8, 2});
  const kernels::CandidateGeometry geometry{8, 0, 4, -1};
  CellSelectionSettings settings;
  settings.cells_are_probabilities = true;
  EXPECT_THROW(make_cell_selection_stage(geometry, settings, maps.outputs()), Error);
  EXPECT_NO_THROW(
      make_cell_selection_stage(geometry, settings, {.disparity_px = maps.disparity_px.view()}));
  settings.cells_are_probabilities = false;
  settings.confidence = ConfidenceMeasure::kProbability;
  EXPECT_THROW(make_cell_selection_stage(geometry, settings, maps.outputs()), Error);
}

}  // namespace vantage::stage_cell_selection_test
