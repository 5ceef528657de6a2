#include "engine/matching/selection/stage_window_selection.h"

#include "engine/image/image.h"
#include "engine/matching/aggregation/stage_column_ssd.h"
#include "engine/matching/costs/intensity_planes.h"
#include "scheduler/whole_image_pipeline.h"
#include "tests/engine/cell_stages.h"
#include "tests/engine/engine_test.h"
#include "tests/engine/plain_aggregation.h"
#include "tests/engine/plain_column.h"
#include "tests/engine/random_grey.h"
#include "tests/test_sample.h"

namespace vantage::stage_window_selection_test {

struct Shape {
  int width;
  int height;
  int disparity_min;
  int count;
  int window;
};

/// A pair of 8-bit noise and the mean cost of every candidate.
struct NoisePair {
  Photograph reference;
  Photograph other;
  std::vector<double> means;  // [y][x][candidate], NaN where it may not win

  NoisePair(const Shape& shape, int direction, int levels, Border border)
      : reference(random_grey(shape.width, shape.height, levels, 1)),
        other(random_grey(shape.width, shape.height, levels, 2)) {
    MethodParameters parameters = book_parameters(MatchMethod::kSsd);
    const DisparityRange range = {shape.disparity_min, shape.disparity_min + shape.count - 1};
    const Side side = direction < 0 ? Side::kLeft : Side::kRight;
    means =
        plain_box_mean(plain_costs(reference, other, side, range, parameters), shape.window, border)
            .cells;
  }
};

/// The integer SSD chain over a pair, and what it should find.
class SsdChain {
 public:
  SsdChain(const Shape& shape, int direction, const NoisePair& pair, int index_shift,
           WindowSelectionSettings settings)
      : shape_(shape),
        noise_(pair),
        geometry_{shape.width, shape.disparity_min, shape.count, direction},
        settings_(settings),
        disparity_px_(shape.width, shape.height),
        confidence_(shape.width, shape.height),
        energy_(shape.width, shape.height) {
    const bool left = direction < 0;
    pair_.prepare(left ? pair.reference : pair.other, left ? pair.other : pair.reference, geometry_,
                  shape.window * shape.window, {left, !left}, execution());
    settings_.radius = shape.window / 2;
    settings_.index_bits = 2 * index_shift;
    const auto& planes = pair_.grey_8;
    source_ = make_column_ssd_stage(left ? planes.left : planes.right,
                                    left ? planes.right_mirrored : planes.left, geometry_,
                                    shape.height, settings_.radius, index_shift);
    select_into({disparity_px_.view(), confidence_.view(), energy_.view()});
  }

  void select_into(const MapOutputs& outputs) {
    selection_ = make_window_selection_stage(geometry_, settings_, outputs);
    supervised_ =
        std::make_unique<scheduler::Supervised>(*selection_, scheduler::Extent(source_->extent()));
    stages_ = {source_.get(), supervised_.get()};
  }
  void run() const { scheduler::run_whole_image(stages_); }
  [[nodiscard]] scheduler::Chain stages() const { return stages_; }
  [[nodiscard]] MapOutputs only_disparity() { return {.disparity_px = disparity_px_.view()}; }

  [[nodiscard]] std::vector<std::uint32_t> bits() const {
    std::vector<std::uint32_t> bits;
    for (const Image<float>* map : {&disparity_px_, &confidence_, &energy_}) {
      for (const auto [x, y] : positions_of(*map)) {
        bits.push_back(std::bit_cast<std::uint32_t>(map->at(x, y)));
      }
    }
    return bits;
  }
  void spoil() {
    for (Image<float>* map : {&disparity_px_, &confidence_, &energy_}) {
      map->fill(-4321.0F);
    }
  }

  void expect_brute_force() const {
    for (const auto [x, y] : positions_of(shape_.width, shape_.height)) {
      SCOPED_TRACE(::testing::Message() << "at " << x << ", " << y);
      ASSERT_NO_FATAL_FAILURE(expect_brute_force(x, y));
    }
  }
  [[nodiscard]] const Image<float>& confidence() const { return confidence_; }

 private:
  void expect_brute_force(int x, int y) const {
    std::vector<double> energies;
    for (int i = 0; i < shape_.count; ++i) {
      const double mean =
          noise_.means[static_cast<std::size_t>((y * shape_.width + x) * shape_.count + i)];
      energies.push_back(mean * settings_.energy_scale - settings_.energy_offset);
    }
    const PlainColumn column(energies);
    const float disparity_px = disparity_px_.at(x, y);
    const float confidence = confidence_.at(x, y);
    const float energy = energy_.at(x, y);
    if (!column.has_candidate()) {
      ASSERT_TRUE(std::isnan(disparity_px) && std::isnan(confidence) && std::isnan(energy));
      return;
    }
    // Not the winner's index: of equal fractions, rounded means may prefer either.
    ASSERT_FALSE(std::isnan(disparity_px));
    ASSERT_NEAR(energy, column.min(), 1e-7 * (1 + std::abs(column.min())));
    switch (settings_.confidence) {
      case ConfidenceMeasure::kMargin:
        ASSERT_NEAR(confidence, column.margin(), 1e-5 * (1e-2 + std::abs(column.margin())));
        break;
      case ConfidenceMeasure::kEntropy:
        ASSERT_LE(confidence, 0);
        // A rounding of the energies, times the scale, reaches the exponent.
        ASSERT_NEAR(confidence, column.entropy(settings_.entropy_scale), 2e-5);
        break;
      default:
        ASSERT_EQ(confidence, -energy);
    }
  }

  Shape shape_;
  const NoisePair& noise_;
  kernels::CandidateGeometry geometry_;
  WindowSelectionSettings settings_;
  PreparedPair pair_;
  Image<float> disparity_px_;
  Image<float> confidence_;
  Image<float> energy_;
  std::unique_ptr<scheduler::RowStage> source_;
  std::unique_ptr<scheduler::RowStage> selection_;
  std::unique_ptr<scheduler::Supervised> supervised_;
  std::vector<const scheduler::RowStage*> stages_;
};

constexpr Shape kShapes[] = {{1, 1, 0, 1, 1},       {1, 1, -3, 7, 9},    {1, 7, 0, 4, 3},
                             {7, 1, 0, 4, 3},       {3, 3, -2, 5, 5},    {16, 9, -16, 33, 3},
                             {31, 13, 3, 38, 7},    {33, 8, -40, 74, 9}, {47, 6, -30, 29, 3},
                             {61, 11, 0, 64, 9},    {65, 10, 5, 60, 1},  {23, 17, 0, 13, 41},
                             {101, 17, -5, 16, 11}, {20, 5, 40, 21, 3}};
constexpr int kShapeCount = static_cast<int>(std::size(kShapes));
constexpr int kDirections[] = {-1, 1};
constexpr Border kBorders[] = {Border::kClip, Border::kValid};

class WindowSelection : public ::testing::TestWithParam<int> {
 protected:
  [[nodiscard]] static const Shape& shape() { return kShapes[GetParam()]; }
};

TEST_P(WindowSelection, EnergyAndConfidenceEqualBruteForce) {
  constexpr int kLevels[] = {1, 2, 256};
  constexpr ConfidenceMeasure kMeasures[] = {
      ConfidenceMeasure::kMargin, ConfidenceMeasure::kEntropy, ConfidenceMeasure::kEvidence};
  // Cells carry their indices where they fit, as 8-bit pairs are matched.
  const int index_shift = shape().count <= 64 && shape().window <= 9 ? 3 : 0;
  static const auto rows = sampled_rows({kShapeCount, 2, 2, 3, 3, 2});
  for (const SampleRow& row : rows_of(rows, GetParam())) {
    SCOPED_TRACE(::testing::Message() << "shape, direction, border, levels, measure, shift: "
                                      << ::testing::PrintToString(row) << ", " << sample_name());
    const int direction = kDirections[row[1]];
    const Border border = kBorders[row[2]];
    const int shift = row[5] == 0 ? 0 : index_shift;
    const NoisePair pair(shape(), direction, kLevels[row[3]], border);
    WindowSelectionSettings settings;
    settings.border = border;
    settings.subpixel = shift == 0 ? Subpixel::kParabola : Subpixel::kNone;
    settings.confidence = kMeasures[row[4]];
    settings.entropy_scale = 1e-3;
    SsdChain chain(shape(), direction, pair, shift, settings);
    chain.spoil();
    chain.run();
    ASSERT_NO_FATAL_FAILURE(chain.expect_brute_force());
  }
}

TEST_P(WindowSelection, EnergiesAreInTheUnitOfTheSettings) {
  static const auto rows = sampled_rows({kShapeCount, 2, 2});
  for (const SampleRow& row : rows_of(rows, GetParam())) {
    WindowSelectionSettings settings;
    settings.border = kBorders[row[2]];
    settings.confidence = ConfidenceMeasure::kEntropy;
    settings.energy_scale = 1.0 / 48;
    settings.energy_offset = 77.5;
    settings.entropy_scale = 0.02;
    const NoisePair pair(shape(), kDirections[row[1]], 256, settings.border);
    SsdChain chain(shape(), kDirections[row[1]], pair, 0, settings);
    chain.spoil();
    chain.run();
    ASSERT_NO_FATAL_FAILURE(chain.expect_brute_force());
  }
}

TEST_P(WindowSelection, IsTheSameInStripsAndWithoutConfidence) {
  static const auto rows = sampled_rows({kShapeCount, 2, 2, 2});
  for (const SampleRow& row : rows_of(rows, GetParam())) {
    WindowSelectionSettings settings;
    settings.border = kBorders[row[2]];
    settings.confidence = row[3] == 0 ? ConfidenceMeasure::kMargin : ConfidenceMeasure::kEntropy;
    const NoisePair pair(shape(), kDirections[row[1]], 16, settings.border);
    SsdChain chain(shape(), kDirections[row[1]], pair, 0, settings);
    chain.spoil();
    chain.run();
    const std::vector<std::uint32_t> expected = chain.bits();
    chain.spoil();
    run_in_strips(chain.stages(), [&] {
      ASSERT_EQ(chain.bits(), expected);
      chain.spoil();
    });
    chain.run();
    // Only the disparities are written again.
    chain.select_into(chain.only_disparity());
    chain.run();
    ASSERT_EQ(chain.bits(), expected);
  }
}

INSTANTIATE_TEST_SUITE_P(AwkwardSizes, WindowSelection, ::testing::Range(0, kShapeCount),
                         [](const auto& instance) {
                           const Shape& s = kShapes[instance.param];
                           return std::to_string(s.width) + "x" + std::to_string(s.height) +
                                  "_window_" + std::to_string(s.window);
                         });

TEST(WindowSelectionSettings, RefuseTheConfidenceOfProbabilities) {
  Image<float> map(8, 2);
  WindowSelectionSettings settings;
  settings.confidence = ConfidenceMeasure::kProbability;
  const kernels::CandidateGeometry geometry{8, 0, 4, -1};
  EXPECT_THROW(make_window_selection_stage(geometry, settings, {map.view(), map.view()}), Error);
  EXPECT_NO_THROW(make_window_selection_stage(geometry, settings, {map.view()}));
}

}  // namespace vantage::stage_window_selection_test
