#include "engine/matching/costs/stage_cost.h"

#include "tests/engine/cell_stages.h"
#include "tests/engine/engine_test.h"
#include "tests/engine/plain_cost_cells.h"
#include "tests/engine/table_keys.h"

namespace vantage::stage_cost_test {

using kernels::CandidateGeometry;

const std::vector<MatchCost> kCosts = all_costs();
constexpr CellMeaning kMeanings[] = {CellMeaning::kEnergy, CellMeaning::kLikelihood};

enum class Kind { kGrey8, kGrey16, kGreyFloat, kColour8, kAlphaFloat };
constexpr Kind kKinds[] = {Kind::kGrey8, Kind::kGrey16, Kind::kGreyFloat, Kind::kColour8,
                           Kind::kAlphaFloat};

template <typename T>
Photograph random_photograph(int width, int height, int channels, std::mt19937& random,
                             unsigned levels, double unit) {
  Image<T> image(width, height, channels);
  for (const auto [k, y] : positions_of(width * channels, height)) {
    // Smooth in places, so that small differences are frequent.
    const unsigned level = random() % 3 == 0 ? static_cast<unsigned>(random() % levels)
                                             : levels / 2 + static_cast<unsigned>(k + y) % 7;
    image.row(y)[k] = static_cast<T>(std::min(level, levels - 1) * unit);
  }
  return {std::move(image)};
}

Photograph random_photograph(Kind kind, int width, int height, unsigned seed) {
  std::mt19937 random(seed);
  switch (kind) {
    case Kind::kGrey8:
      return random_photograph<std::uint8_t>(width, height, 1, random, 256, 1);
    case Kind::kGrey16:
      return random_photograph<std::uint16_t>(width, height, 1, random, 4096, 15);
    case Kind::kGreyFloat:
      return random_photograph<float>(width, height, 1, random, 512, 1 / 512.);
    case Kind::kColour8:
      return random_photograph<std::uint8_t>(width, height, 3, random, 256, 1);
    case Kind::kAlphaFloat:
      return random_photograph<float>(width, height, 4, random, 512, 1 / 512.);
  }
  return {};
}

/// One stage to be tested, with everything it looks at.
struct CostCase {
  MethodParameters parameters = book_parameters(MatchMethod::kBayes);
  CandidateGeometry geometry;
  CellMeaning meaning = CellMeaning::kEnergy;
  Photograph reference;
  std::vector<Photograph> others;
  std::vector<PlainPartner> partners;  ///< photographs: of `others`, in order
};

std::string describe(const CostCase& test) {
  return "cost " + std::to_string(static_cast<int>(test.parameters.cost)) + ", meaning " +
         std::to_string(static_cast<int>(test.meaning)) + ", " +
         std::to_string(test.geometry.width) + "x" + std::to_string(test.reference.height()) +
         ", disparities from " + std::to_string(test.geometry.disparity_min) + ", direction " +
         std::to_string(test.geometry.direction) + ", " + std::to_string(test.partners.size()) +
         " partners, ratio " + std::to_string(test.partners.front().ratio) + ", row shift " +
         std::to_string(test.partners.front().disparity_y_px) + ", " +
         std::to_string(test.geometry.steps_per_px) + " steps a pixel";
}

class StageCost : public ::testing::Test {
 protected:
  std::unique_ptr<scheduler::RowStage> make_stage(const CostCase& test) {
    CandidateGeometry left = test.geometry;
    left.direction = -1;
    const auto prepare = [&](CostImage& image, const Photograph& photograph, CostImageUse use) {
      image.prepare(photograph, test.parameters, left, use, *execution_);
    };
    prepare(reference_, test.reference, {true, false, false});
    images_.resize(std::max(images_.size(), test.others.size()));
    std::vector<CostPartner> partners;
    for (std::size_t k = 0; k < test.others.size(); ++k) {
      const bool as_partner_of_left = test.geometry.direction * test.partners[k].ratio < 0;
      prepare(images_[k], test.others[k],
              {.as_reference = false,
               .as_partner_of_left = as_partner_of_left,
               .as_partner_of_right = !as_partner_of_left,
               .phases = sample_phases(test.partners[k].ratio, test.geometry.steps_per_px)});
      partners.push_back({&images_[k], test.partners[k].ratio, test.partners[k].disparity_y_px});
    }
    return make_cost_stage(test.parameters, test.geometry, reference_, partners, test.meaning,
                           test.reference.height());
  }

  /// `strips`: by the strip pipeline instead.
  CellVolume<float> cells_of(const CostCase& test, bool strips = false) {
    const auto stage = make_stage(test);
    CellVolume<float> cells(stage->extent(), test.geometry.lanes());
    const CellSink<float> sink(cells);
    const scheduler::RowStage* const chain[] = {stage.get(), &sink};
    if (!strips) {
      scheduler::run_whole_image(chain);
      return cells;
    }
    scheduler::PlanRequest request;
    request.strip_columns = 7;
    request.band_rows = 4;
    scheduler::run_strips(chain, scheduler::plan_chain(chain, execution_->machine(), request),
                          execution_->executor(), execution_->scratch());
    return cells;
  }

  void expect_plain_cells(CostCase& test) {
    for (std::size_t k = 0; k < test.others.size(); ++k) {
      test.partners[k].photograph = &test.others[k];
    }
    const PlainCostCells plain(test.parameters, test.geometry, test.reference, test.partners,
                               test.meaning);
    const CellVolume<float> cells = cells_of(test);
    for (const auto [x, y] : positions_of(test.geometry.width, test.reference.height())) {
      const std::vector<double> expected = plain.column(x, y);
      const float* actual = &cells.at(x, y, 0);
      for (int i = 0; i < test.geometry.lanes(); ++i) {
        if (i < test.geometry.count) {
          const double value = expected[static_cast<std::size_t>(i)];
          ASSERT_NEAR(actual[i], value, bound(test, value))
              << "at " << x << ", " << y << ", candidate " << i;
        } else if (test.meaning == CellMeaning::kLikelihood) {
          ASSERT_EQ(actual[i], 0);
        } else {
          ASSERT_TRUE(std::isfinite(actual[i]));
        }
      }
    }
  }

  /// Of each of `costs`, as energies and as likelihoods.
  void expect_plain_cells(CostCase& test, const std::vector<MatchCost>& costs) {
    for (const MatchCost cost : costs) {
      test.parameters.cost = cost;
      for (const CellMeaning meaning : kMeanings) {
        test.meaning = meaning;
        SCOPED_TRACE(describe(test));
        ASSERT_NO_FATAL_FAILURE(expect_plain_cells(test));
      }
    }
  }

  /// Largest error of a float cell: grey levels are exact to 5e-5.
  static double bound(const CostCase& test, double value) {
    const auto partners = static_cast<double>(test.others.size());
    if (test.meaning == CellMeaning::kLikelihood) {
      return 3e-5;
    }
    switch (test.parameters.cost) {
      case MatchCost::kSquared:
        return partners * 1e-4 * std::sqrt(value) + 1e-6 * value + 1e-8;
      case MatchCost::kGradient:
        return 1e-3;
      case MatchCost::kCensus:
      case MatchCost::kRayCensus:
        return partners * 1e-5;
      default:
        return partners * 1e-4;
    }
  }

  static ExecutionOptions two_threads() {
    ExecutionOptions options;
    options.threads = 2;
    return options;
  }

  std::optional<Execution> execution_{two_threads()};
  CostImage reference_;
  std::vector<CostImage> images_;
};

struct Shape {
  int width;
  int height;
  int disparity_min;
  int count;
};
constexpr Shape kShapes[] = {{1, 1, 0, 1},   {1, 6, -2, 5},   {9, 1, 0, 16},   {5, 3, -20, 40},
                             {23, 5, 0, 17}, {31, 4, -3, 11}, {19, 7, -30, 9}, {40, 3, 4, 64}};

CostCase pair_case(Kind kind, const Shape& shape, int direction) {
  CostCase test;
  test.geometry = {shape.width, shape.disparity_min, shape.count, direction};
  test.reference = random_photograph(kind, shape.width, shape.height, 1);
  test.others.push_back(random_photograph(kind, shape.width, shape.height, 2));
  test.partners.resize(1);
  return test;
}

TEST_F(StageCost, EqualsPlainCellsForAllCostsAndImages) {
  for (const Kind kind : kKinds) {
    for (const Shape& shape : kShapes) {
      for (const int direction : {-1, 1}) {
        CostCase test = pair_case(kind, shape, direction);
        test.parameters.census_thresholds = direction < 0 ? 3 : 1;
        for (const ColourUse colour : {ColourUse::kLuma, ColourUse::kChannels}) {
          test.parameters.colour = colour;
          ASSERT_NO_FATAL_FAILURE(expect_plain_cells(test, kCosts));
        }
      }
    }
  }
}

TEST_F(StageCost, EqualsPlainCellsForAllGradients) {
  CostCase test = pair_case(Kind::kGrey8, {23, 9, -3, 14}, -1);
  test.parameters.cost = MatchCost::kGradient;
  for (const GradientFilter filter :
       {GradientFilter::kCentral, GradientFilter::kSobel, GradientFilter::kSimoncelli3,
        GradientFilter::kSimoncelli5, GradientFilter::kForward}) {
    for (const GradientNorm norm :
         {GradientNorm::kL2, GradientNorm::kOctagon, GradientNorm::kL1, GradientNorm::kMax}) {
      for (const bool prefilter : {false, true}) {
        for (const double alpha : {0., .7, 1., 3.}) {
          test.parameters.gradient = filter;
          test.parameters.norm = norm;
          test.parameters.prefilter = prefilter;
          test.parameters.alpha = alpha;
          test.parameters.gradient_components = norm == GradientNorm::kMax && prefilter
                                                    ? GradientComponents::kX
                                                    : GradientComponents::kXy;
          SCOPED_TRACE("filter " + std::to_string(static_cast<int>(filter)));
          expect_plain_cells(test);
          ASSERT_FALSE(HasFatalFailure());
        }
      }
    }
  }
}

TEST_F(StageCost, EqualsPlainCellsForOtherBaselines) {
  for (const double ratio : {.5, 2., -1., 1.37, -.25, 1. / 3}) {
    for (const int direction : {-1, 1}) {
      for (const Shape& shape : {kShapes[3], kShapes[5], kShapes[6]}) {
        // Whole grey levels: others have other ties in float than in double, which census codes
        // show.
        CostCase test = pair_case(Kind::kGrey8, shape, direction);
        test.partners[0].ratio = ratio;
        // Thirds are not exact.
        const auto costs = keys_in(cost_table(), [&](const MatchingCost& cost) {
          return ratio != 1. / 3 ||
                 (cost.key != MatchCost::kCensus && cost.key != MatchCost::kRayCensus);
        });
        ASSERT_NO_FATAL_FAILURE(expect_plain_cells(test, costs));
      }
    }
  }
}

TEST_F(StageCost, EqualsPlainCellsForCandidatesBetweenPixels) {
  for (const int steps : {2, 4}) {
    for (const double ratio : {1., -.5, 3.}) {
      for (const Shape& shape : kShapes) {
        CostCase test = pair_case(Kind::kGrey8, shape, steps == 2 ? -1 : 1);
        test.geometry.steps_per_px = steps;
        test.partners[0].ratio = ratio;
        ASSERT_NO_FATAL_FAILURE(expect_plain_cells(test, all_costs()));
      }
    }
  }
}

TEST_F(StageCost, EqualsPlainCellsForOtherRowsAndSides) {
  for (const int disparity_y_px : {-2, 2, 50}) {
    for (const double ratio : {1., -1.}) {
      for (const int direction : {-1, 1}) {
        CostCase test = pair_case(Kind::kGrey16, {21, 6, -4, 18}, direction);
        test.partners[0] = {nullptr, ratio, disparity_y_px};
        ASSERT_NO_FATAL_FAILURE(expect_plain_cells(test, kCosts));
      }
    }
  }
}

/// Three other images, one of them grey beside colours, at different places.
CostCase several_partners(const Shape& shape, int direction, bool interpolated) {
  CostCase test = pair_case(Kind::kColour8, shape, direction);
  test.others.push_back(random_photograph(Kind::kGreyFloat, shape.width, shape.height, 3));
  test.others.push_back(random_photograph(Kind::kColour8, shape.width, shape.height, 4));
  test.partners = {{nullptr, 1, 0}, {nullptr, -1, 1}, {nullptr, interpolated ? 1.5 : 1, -1}};
  test.parameters.colour = ColourUse::kChannels;
  return test;
}

TEST_F(StageCost, EqualsPlainCellsForSeveralPartners) {
  for (const bool interpolated : {false, true}) {
    for (const int direction : {-1, 1}) {
      for (const Shape& shape : kShapes) {
        CostCase test = several_partners(shape, direction, interpolated);
        ASSERT_NO_FATAL_FAILURE(expect_plain_cells(test, kCosts));
      }
    }
  }
}

TEST_F(StageCost, StripsEqualTheWholeImage) {
  for (const bool interpolated : {false, true}) {
    for (const int direction : {-1, 1}) {
      CostCase test = several_partners({53, 11, -5, 20}, direction, interpolated);
      for (const std::size_t partners : {std::size_t{1}, std::size_t{3}}) {
        test.others.resize(partners);
        test.partners.resize(partners);
        for (const MatchCost cost : all_costs()) {
          test.parameters.cost = cost;
          for (const CellMeaning meaning : kMeanings) {
            test.meaning = meaning;
            SCOPED_TRACE(describe(test));
            const CellVolume<float> whole = cells_of(test);
            const CellVolume<float> in_strips = cells_of(test, true);
            ASSERT_EQ(std::memcmp(in_strips.cells.data(), whole.cells.data(),
                                  whole.cells.size() * sizeof(float)),
                      0);
          }
        }
        test = several_partners({53, 11, -5, 20}, direction, interpolated);
      }
    }
  }
}

TEST_F(StageCost, ReusedImagesAndOtherThreadsChangeNothing) {
  for (const MatchCost cost : all_costs()) {
    CostCase large = pair_case(Kind::kColour8, {61, 40, -9, 33}, -1);
    large.parameters.cost = cost;
    large.parameters.colour = ColourUse::kChannels;
    CostCase small = pair_case(Kind::kGrey8, {13, 5, 0, 12}, -1);
    small.parameters.cost = cost;
    cells_of(large);
    const CellVolume<float> reused = cells_of(small);
    reference_ = {};
    images_.clear();
    ExecutionOptions serial;
    serial.threads = 1;
    serial.executor = scheduler::ExecutorKind::kSerial;
    execution_.emplace(serial);
    EXPECT_EQ(cells_of(small).cells, reused.cells);
    execution_.emplace(two_threads());
  }
}

TEST_F(StageCost, RefusesBaselinesItCannotServe) {
  CostCase test = pair_case(Kind::kGrey8, {8, 2, 0, 4}, -1);
  for (const double ratio : {0., std::nan(""), 1e6}) {
    test.partners[0].ratio = ratio;
    EXPECT_THROW(make_stage(test), UsageError) << ratio;
  }
}

}  // namespace vantage::stage_cost_test
