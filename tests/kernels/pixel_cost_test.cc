#include "kernels/pixel_cost/pixel_cost.h"

#include "kernels/candidates.h"
#include "kernels/cells/exp_log.h"
#include "tests/kernels/feature_rows.h"
#include "tests/kernels/kernel_test_utils.h"

namespace vantage::kernels::pixel_cost_test {

/// Grey levels with fractions; equal pairs and extremes are frequent.
float draw_grey(std::mt19937& random) {
  switch (random() % 8) {
    case 0:
      return 0;
    case 1:
      return 255;
    default:
      return static_cast<float>(random() % 25501U) / 100;
  }
}

struct Model {
  double sigma;
  double epsilon;
};
constexpr Model kModels[] = {{5, .1}, {.1, .01}, {20, .999}, {1e-30, 1e-40}, {1e20, .5}};

double measurement(const Model& model, double squared_residual) {
  return (1 - model.epsilon) * std::exp(-squared_residual / (2 * model.sigma * model.sigma)) +
         model.epsilon;
}

/// Mean over the channels of cost(reference, partner) in double.
template <typename Cost>
double mean(const GreyPairs& row, int j, int i, const Cost& cost) {
  double sum = 0;
  for (int c = 0; c < row.channels; ++c) {
    const auto& channel = row.channel[c];
    sum +=
        cost(double{channel.reference[0][j]}, double{channel.partner[0][j * row.partner_step + i]});
  }
  return sum / row.channels;
}

double squared(double reference, double partner) {
  return (reference - partner) * (reference - partner);
}

/// cells[j · lanes + i] must be expected(j, i) up to a relative and an absolute error.
template <typename Expected>
void expect_near(const GreyPairs& row, const std::vector<float>& cells, double relative,
                 double absolute, const Expected& expected) {
  for (int j = 0; j < row.columns; ++j) {
    for (int i = 0; i < row.lanes; ++i) {
      const double value = expected(j, i);
      ASSERT_NEAR(cells[j * row.lanes + i], value, std::abs(value) * relative + absolute)
          << "column " << j << ", lane " << i << " of " << row.count;
    }
  }
}

TEST(PixelCost, SquaredDifference) {
  for_each_feature_rows<float, 1>(draw_grey, [](const GreyPairs& row) {
    const auto cells = row_on_every_target<float>(cell_count(row), squared_row, row);
    expect_near(row, cells, 4e-7, 1e-5, [&](int j, int i) { return mean(row, j, i, squared); });
  });
}

TEST(PixelCost, AbsoluteDifference) {
  for (const float truncation : {std::numeric_limits<float>::infinity(), 20.0F, .5F}) {
    for_each_feature_rows<float, 1>(draw_grey, [&](const GreyPairs& row) {
      const auto cells = row_on_every_target<float>(cell_count(row), absolute_row, row, truncation);
      expect_near(row, cells, 4e-7, 1e-5, [&](int j, int i) {
        return mean(row, j, i, [&](double a, double b) {
          return std::min<double>(std::abs(a - b), truncation);
        });
      });
    });
  }
}

TEST(PixelCost, SamplingInsensitiveDifference) {
  for_each_feature_rows<float, 3>(draw_grey, [](const SampledPairs& row) {
    const auto cells = row_on_every_target<float>(cell_count(row), sampling_insensitive_row, row);
    const auto outside = [](float value, float low, float high) {
      return std::max({0.0, double{value} - high, double{low} - value});
    };
    for (int j = 0; j < row.columns; ++j) {
      for (int i = 0; i < row.lanes; ++i) {
        double sum = 0;
        for (int c = 0; c < row.channels; ++c) {
          const auto& [a, b] = row.channel[c];
          const int k = j * row.partner_step + i;
          sum += std::min(outside(a[0][j], b[1][k], b[2][k]), outside(b[0][k], a[1][j], a[2][j]));
        }
        ASSERT_NEAR(cells[j * row.lanes + i], sum / row.channels, 1e-4);
      }
    }
  });
}

TEST(PixelCost, SamplingInsensitiveDifferenceByHand) {
  // 60 is 10 above the partner's interval 31 … 50; the partner's 45 is 3 above 40 … 42.
  const std::vector<float> reference[] = {{60}, {40}, {42}};
  std::vector<float> partner[] = {std::vector<float>(16, 45), std::vector<float>(16, 31),
                                  std::vector<float>(16, 50)};
  partner[0][1] = 41;  // inside
  partner[0][2] = 35;  // 5 below
  partner[1][3] = 61;  // the reference 1 below
  partner[2][3] = 70;
  SampledPairs row;
  for (std::size_t p = 0; p < 3; ++p) {
    row.channel[0].reference[p] = reference[p].data();
    row.channel[0].partner[p] = partner[p].data();
  }
  row.columns = 1;
  row.lanes = 16;
  row.count = 16;
  std::vector<float> cells(16);
  sampling_insensitive_row(row, cells.data());
  EXPECT_EQ(cells[0], 3);
  EXPECT_EQ(cells[1], 0);
  EXPECT_EQ(cells[2], 5);
  EXPECT_EQ(cells[3], 1);
}

TEST(PixelCost, SamplingBounds) {
  std::mt19937 random(3);
  for (const int width : {1, 2, 15, 16, 17, 33}) {
    const int padded = (width + 15) / 16 * 16;
    UnalignedRow<float> grey(static_cast<std::size_t>(padded) + 2, random() % 5);
    for (std::size_t k = 0; k < grey.size(); ++k) {
      grey[k] = draw_grey(random);
    }
    const auto padded_size = static_cast<std::size_t>(padded);
    std::vector<float> max(padded_size);
    const auto min = row_on_every_target<float>(padded_size, [&](float* out) {
      sampling_bounds_row(grey.data() + 1, width, out, max.data());
      std::fill(out + width, out + padded, 0.0F);  // anything
    });
    for (int x = 0; x < width; ++x) {
      const float* at = grey.data() + 1 + x;
      const auto k = static_cast<std::size_t>(x);
      ASSERT_FLOAT_EQ(min[k], std::min({at[0], (at[0] + at[-1]) / 2, (at[0] + at[1]) / 2}));
      ASSERT_FLOAT_EQ(max[k], std::max({at[0], (at[0] + at[-1]) / 2, (at[0] + at[1]) / 2}));
    }
  }
}

TEST(PixelCost, ContaminatedEnergy) {
  for (const Model& model : kModels) {
    const auto parameters = ContaminatedGaussian::of(model.sigma, model.epsilon);
    const Model in_force{model.sigma, parameters.epsilon};
    for_each_feature_rows<float, 1>(draw_grey, [&](const GreyPairs& row) {
      const auto cells =
          row_on_every_target<float>(cell_count(row), contaminated_energy_row, row, parameters);
      // The argument of the logarithm carries the error of the residual over σ².
      expect_near(row, cells, 4e-6, 4e-7, [&](int j, int i) {
        return mean(row, j, i, [&](double a, double b) {
          return -std::log(measurement(in_force, squared(a, b)));
        });
      });
    });
  }
}

TEST(PixelCost, ContaminatedLikelihood) {
  for (const Model& model : kModels) {
    const auto parameters = ContaminatedGaussian::of(model.sigma, model.epsilon);
    const Model in_force{model.sigma, parameters.epsilon};
    for_each_feature_rows<float, 1>(draw_grey, [&](const GreyPairs& row) {
      const auto cells =
          row_on_every_target<float>(cell_count(row), contaminated_likelihood_row, row, parameters);
      expect_near(row, cells, 4e-7, 4e-7, [&](int j, int i) {
        return i < row.count ? measurement(in_force, mean(row, j, i, squared)) : 0;
      });
    });
  }
}

TEST(PixelCost, LikelihoodOfCosts) {
  std::mt19937 random(5);
  const Model model{5, .1};
  const auto parameters = ContaminatedGaussian::of(model.sigma, model.epsilon);
  for (const int lanes : kLaneCounts) {
    for (const int columns : {1, 2, 5}) {
      const CellExtent row{columns, lanes, random_int(random, 1, lanes)};
      std::vector<float> costs(columns * lanes);
      std::generate(costs.begin(), costs.end(), [&] { return draw_grey(random) / 8; });
      const auto cells = row_on_every_target<float>(costs.size(), [&](float* out) {
        std::copy(costs.begin(), costs.end(), out);
        likelihood_of_costs(row, parameters, out);
      });
      for (std::size_t k = 0; k < costs.size(); ++k) {
        const bool is_candidate = static_cast<int>(k) % lanes < row.count;
        const double cost = costs[k];
        ASSERT_NEAR(cells[k], is_candidate ? measurement(model, cost * cost) : 0, 4e-7);
      }
    }
  }
}

TEST(PixelCost, LikelihoodsOfEnergies) {
  std::mt19937 random(7);
  for (const int count : {1, 15, 16, 17, 40}) {
    const int lanes = CandidateGeometry{1, 0, count, -1}.lanes();
    const CellExtent row{3, lanes, count};
    std::vector<float> energies(3 * lanes);
    std::generate(energies.begin(), energies.end(), [&] { return draw_grey(random) / 20; });
    energies[0] = 0;
    const auto cells = row_on_every_target<float>(energies.size(), [&](float* out) {
      std::copy(energies.begin(), energies.end(), out);
      likelihood_of_energies(row, out);
    });
    for (std::size_t k = 0; k < energies.size(); ++k) {
      const bool is_candidate = static_cast<int>(k) % lanes < count;
      ASSERT_NEAR(cells[k], is_candidate ? std::exp(-static_cast<double>(energies[k])) : 0, 1e-6);
    }
  }
}

TEST(ExpLog, Exponential) {
  EXPECT_EQ(exp2_of_negative(0), 1);
  for (float exponent = 0; exponent > -125; exponent -= .00317F) {
    const double expected = std::exp2(double{exponent});
    ASSERT_NEAR(exp2_of_negative(exponent), expected, 3e-7 * expected) << exponent;
  }
  const double min = std::exp2(-125.0);
  EXPECT_EQ(exp2_of_negative(-125), min);
  EXPECT_EQ(exp2_of_negative(-1e30F), min);
  EXPECT_EQ(exp2_of_negative(-std::numeric_limits<float>::infinity()), min);
}

TEST(ExpLog, Logarithm) {
  EXPECT_EQ(log_of_normal(1), 0);
  for (double value = 1e-37; value < 3; value *= 1.00071) {
    const auto argument = static_cast<float>(value);
    const double expected = std::log(double{argument});
    ASSERT_NEAR(log_of_normal(argument), expected, 2e-7 * std::max(1.0, std::abs(expected)))
        << argument;
  }
}

}  // namespace vantage::kernels::pixel_cost_test
