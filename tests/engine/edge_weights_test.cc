#include "engine/matching/aggregation/edge_weights.h"
#include "engine/matching/levels/level_extents.h"

#include "engine/matching/aggregation/aggregation_table.h"
#include "engine/matching/search/coarse_to_fine/coarse_to_fine.h"
#include "tests/engine/engine_test.h"
#include "tests/engine/table_keys.h"

namespace vantage::edge_weights_test {

MethodParameters parameters_with(double edge_weight, int levels) {
  MethodParameters parameters = book_parameters(MatchMethod::kBayes);
  parameters.edge_weight = edge_weight;
  parameters.edge_contrast = 5;
  parameters.levels = levels;
  return parameters;
}

Photograph random_photograph(int width, int height, int channels) {
  std::mt19937 random(7);
  Image<std::uint8_t> image(width, height, channels);
  for (int y = 0; y < height; ++y) {
    std::generate_n(image.row(y), width * channels,
                    [&] { return static_cast<std::uint8_t>(random() % 40); });
  }
  return {std::move(image)};
}

/// Luma in double, and of coarser levels the mean of what is there of each block.
struct PlainGrey {
  int width = 0;
  int height = 0;
  std::vector<double> levels;
  [[nodiscard]] double at(int x, int y) const {
    return levels[static_cast<std::size_t>(y * width + x)];
  }
  [[nodiscard]] double weight(int x, int y, int u, int v) const {
    return 0.2 + 0.8 * std::exp(-std::abs(at(x, y) - at(u, v)) / 5);
  }
};

PlainGrey grey_of(const Photograph& photograph) {
  const auto& image = std::get<Image<std::uint8_t>>(photograph.pixels);
  PlainGrey grey{image.width(), image.height(), {}};
  for (const auto [x, y] : positions_of(grey.width, grey.height)) {
    grey.levels.push_back(image.channels() == 1
                              ? image.at(x, y)
                              : 0.299 * image.at(x, y, 0) + 0.587 * image.at(x, y, 1) +
                                    0.114 * image.at(x, y, 2));
  }
  return grey;
}

PlainGrey halved(const PlainGrey& finer) {
  PlainGrey coarser{(finer.width + 1) / 2, (finer.height + 1) / 2, {}};
  for (const auto [x, y] : positions_of(coarser.width, coarser.height)) {
    double sum = 0;
    int samples = 0;
    for (int v = 2 * y; v < std::min(2 * y + 2, finer.height); ++v) {
      for (int u = 2 * x; u < std::min(2 * x + 2, finer.width); ++u, ++samples) {
        sum += finer.at(u, v);
      }
    }
    coarser.levels.push_back(sum / samples);
  }
  return coarser;
}

/// One step of anisotropic diffusion.
PlainGrey diffused(const PlainGrey& grey) {
  PlainGrey result = grey;
  for (const auto [x, y] : positions_of(grey.width, grey.height)) {
    for (const auto& [u, v] :
         {std::pair(x - 1, y), std::pair(x + 1, y), std::pair(x, y - 1), std::pair(x, y + 1)}) {
      if (u >= 0 && u < grey.width && v >= 0 && v < grey.height) {
        const double difference = grey.at(u, v) - grey.at(x, y);
        result.levels[static_cast<std::size_t>(y * grey.width + x)] +=
            0.2 * difference * std::exp(-std::abs(difference) / 5);
      }
    }
  }
  return result;
}

TEST(EdgeWeightLevels, AreThoseOfNeighboursOnEachLevel) {
  EdgeWeightLevels levels;
  struct Shape {
    int width;
    int height;
    int channels;
  };
  for (const Shape& shape : {Shape{37, 29, 1}, Shape{21, 13, 3}, Shape{1, 7, 1}, Shape{1, 1, 1},
                             Shape{5, 1, 3}, Shape{64, 33, 1}}) {
    const Photograph photograph = random_photograph(shape.width, shape.height, shape.channels);
    const auto weights = levels.prepare(photograph, parameters_with(0.2, 4), execution());
    PlainGrey grey = grey_of(photograph);
    for (const EdgeWeights& level : weights) {
      for (int y = 0; y < grey.height; ++y) {
        for (int x = 0; x <= grey.width; ++x) {
          const bool inside = x > 0 && x < grey.width;
          ASSERT_NEAR(level.of_iteration(1).beside(y)[x], inside ? grey.weight(x - 1, y, x, y) : 1,
                      2e-6);
        }
      }
      for (int y = 0; y <= grey.height; ++y) {
        for (int x = 0; x < grey.width; ++x) {
          const bool inside = y > 0 && y < grey.height;
          ASSERT_NEAR(level.of_iteration(1).above(y)[x], inside ? grey.weight(x, y - 1, x, y) : 1,
                      2e-6);
        }
      }
      grey = halved(grey);
    }
  }
}

TEST(EdgeWeights, AreThoseOfTheImageDiffusedAlong) {
  constexpr int kSteps = 3;
  MethodParameters parameters = parameters_with(0.2, 1);
  parameters.edge_diffusion = kSteps;
  for (const auto& [width, height] : {std::pair(23, 17), std::pair(1, 9), std::pair(1, 1)}) {
    const Photograph photograph = random_photograph(width, height, 1);
    Image<float> grey(width, height);
    for (int y = 0; y < height; ++y) {
      std::copy_n(std::get<Image<std::uint8_t>>(photograph.pixels).row(y), width, grey.row(y));
    }
    for (const int threads : {1, 3}) {
      Execution execution({.threads = threads});
      EdgeWeights weights;
      weights.prepare(std::as_const(grey).view(), parameters, execution);
      PlainGrey seen = grey_of(photograph);
      for (int n = 1; n <= kSteps + 2; ++n) {
        seen = n <= kSteps ? diffused(seen) : seen;
        for (int y = 0; y < height; ++y) {
          for (int x = 1; x < width; ++x) {
            ASSERT_NEAR(weights.of_iteration(n).beside(y)[x], seen.weight(x - 1, y, x, y), 1e-4)
                << n;
          }
          for (int x = 0; x < width && y > 0; ++x) {
            ASSERT_NEAR(weights.of_iteration(n).above(y)[x], seen.weight(x, y - 1, x, y), 1e-4);
          }
        }
      }
    }
  }
}

TEST(EdgeWeightLevels, AreTheSameInFixedPointWithTheWeightOfNeighbours) {
  MethodParameters parameters = parameters_with(0.2, 4);
  parameters.mu = 0.3;
  for (const auto& [width, height] : {std::pair(37, 29), std::pair(1, 1), std::pair(3, 40)}) {
    const Photograph photograph = random_photograph(width, height, 1);
    EdgeWeightLevels in_floats;
    EdgeWeightLevels in_fixed_point;
    parameters.prior_smoothing = PriorSmoothing::kSum;
    const auto floats = in_floats.prepare(photograph, parameters, execution());
    parameters.prior_smoothing = PriorSmoothing::kMaximum;
    const auto fixed = in_fixed_point.prepare(photograph, parameters, execution());
    ASSERT_EQ(floats.size(), fixed.size());
    const auto extents = level_extents({width, height}, 4);
    for (std::size_t level = 0; level < fixed.size(); ++level) {
      const auto [columns, rows] = extents[level];
      for (int y = 0; y <= rows; ++y) {
        for (int x = 0; x <= columns; ++x) {
          if (y < rows) {
            ASSERT_EQ(fixed[level].of_iteration(1).fixed_beside(y)[x],
                      kernels::fixed_weight(0.3F * floats[level].of_iteration(1).beside(y)[x]));
          }
          if (x < columns) {
            ASSERT_EQ(fixed[level].of_iteration(1).fixed_above(y)[x],
                      kernels::fixed_weight(0.3F * floats[level].of_iteration(1).above(y)[x]));
          }
        }
      }
    }
  }
}

TEST(EdgeWeightLevels, AsManyAsTheImageHas) {
  EdgeWeightLevels levels;
  const Photograph photograph = random_photograph(37, 29, 1);
  EXPECT_EQ(levels.prepare(photograph, parameters_with(0.2, 1), execution()).size(), 1U);
  EXPECT_EQ(levels.prepare(photograph, parameters_with(0.2, 10), execution()).size(), 6U);
  EXPECT_TRUE(levels.prepare(photograph, parameters_with(1, 4), execution()).empty());
  for (const Aggregation aggregation : all_aggregations()) {
    MethodParameters parameters = parameters_with(0.2, 4);
    parameters.aggregation = aggregation;
    EXPECT_EQ(levels.prepare(photograph, parameters, execution()).empty(),
              !aggregation_of(aggregation).is_iterative);
  }
}

TEST(EdgeWeightLevels, TakeWhatIsPlanned) {
  const Photograph photograph = random_photograph(320, 240, 1);
  MethodParameters parameters = parameters_with(0.2, 5);
  for (const PriorSmoothing smoothing : {PriorSmoothing::kSum, PriorSmoothing::kMaximum}) {
    parameters.prior_smoothing = smoothing;
    parameters.edge_diffusion = smoothing == PriorSmoothing::kSum ? 4 : 0;
    parameters.final_iterations = 2;
    EdgeWeightLevels levels;
    levels.prepare(photograph, parameters, execution());
    const auto held = static_cast<double>(levels.held_bytes());
    const auto planned = static_cast<double>(edge_weight_bytes(parameters, 320 * 240));
    EXPECT_LE(held, 1.1 * planned);  // rows are padded
    EXPECT_GE(held, 0.8 * planned);
  }
  EXPECT_EQ(edge_weight_bytes(parameters_with(1, 5), 320 * 240), 0U);
}

}  // namespace vantage::edge_weights_test
