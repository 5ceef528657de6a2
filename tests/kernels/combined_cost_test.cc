#include "kernels/combined_cost/combined_cost.h"

#include <bit>

#include "tests/kernels/feature_rows.h"
#include "tests/kernels/kernel_test_utils.h"

namespace vantage::kernels::combined_cost_test {

struct Case {
  CombinedSigmas sigmas;
  double epsilon;
};
constexpr Case kCases[] = {{{5, .2, 4}, .1},     {{3, 0, 0}, .01},       {{5, .15, 0}, .05},
                           {{20, 0, .7}, 1e-40}, {{1e-9, 1, 1e9}, .999}, {{1e12, .01, 1e-9}, .3}};

/// Levels, bounds around them and codes of one shape.
class Rows {
 public:
  Rows(std::mt19937& random, int channels, PartnerOrder order, int columns, int lanes)
      : levels_(random, channels, order, columns, lanes, [&] { return draw(random, kMaxFixed); }),
        codes_(random, 1, order, columns, lanes, [&] { return draw_code(random); }),
        gradients_(random, 1, order, columns, lanes,
                   [&] { return draw(random, kMaxFixedGradient); }) {
    row_ = {levels_.pairs(), codes_.pairs(), gradients_.pairs()};
  }
  [[nodiscard]] const CombinedRow& row() const { return row_; }

 private:
  /// Often near the middle, so that small differences are frequent; extremes are, too.
  static std::uint16_t draw(std::mt19937& random, int max) {
    switch (random() % 8) {
      case 0:
        return 0;
      case 1:
        return static_cast<std::uint16_t>(max);
      case 2:
        return static_cast<std::uint16_t>(random() % static_cast<unsigned>(max + 1));
      default:
        return static_cast<std::uint16_t>(max / 2 + static_cast<int>(random() % 400));
    }
  }
  /// 31 bits, few of them set, so that all distances occur.
  static std::uint32_t draw_code(std::mt19937& random) {
    const auto bits = static_cast<std::uint32_t>(random()) & 0x7FFFFFFFU;
    return random() % 4 == 0   ? bits
           : random() % 2 == 0 ? bits & static_cast<std::uint32_t>(random())
                               : 0x7FFFFFFFU;
  }

  FeatureRows<std::uint16_t, 3> levels_;
  FeatureRows<std::uint32_t, 2> codes_;
  FeatureRows<std::uint16_t, 2> gradients_;
  CombinedRow row_;
};

template <typename Check>
void for_each_rows(const Check& check) {
  for_each_row_shape(
      11, [&](std::mt19937& random, int channels, PartnerOrder order, int columns, int lanes) {
        check(Rows(random, channels, order, columns, lanes).row());
      });
}

/// (1−ε) exp(−r²/2σ²) + ε.
double measurement(double residual, double sigma, double epsilon) {
  return (1 - epsilon) * std::exp(-residual * residual / (2 * sigma * sigma)) + epsilon;
}

double outside(double value, double low, double high) {
  return std::max({0.0, value - high, low - value});
}

double grey_residual(const FixedIntensityPairs& row, int j, int k) {
  double sum = 0;
  for (int c = 0; c < row.channels; ++c) {
    const auto& [a, b] = row.channel[c];
    sum += std::min(outside(a[0][j], b[1][k], b[2][k]), outside(b[0][k], a[1][j], a[2][j])) / 32;
  }
  return sum / row.channels;
}

double census_residual(const CensusPairs& row, int j, int k) {
  const auto& [a, b] = row.channel[0];
  int bits = 0;
  for (std::size_t half = 0; half < 2; ++half) {
    for (int bit = 0; bit < 31; ++bit) {
      bits += ((a[half][j] ^ b[half][k]) >> bit & 1U) != 0 ? 1 : 0;
    }
  }
  return bits / 62.0;
}

double gradient_residual(const FixedGradientPairs& row, int j, int k) {
  const auto& [a, b] = row.channel[0];
  return (std::abs(1.0 * a[0][j] - b[0][k]) + std::abs(1.0 * a[1][j] - b[1][k])) / 32;
}

/// Bounds of −log p that a residual within `reach` of r can have, with room for rounded tables.
struct Bounds {
  double min = 0;
  double max = 0;
};
Bounds energy_bounds(double residual, double reach, double sigma, double epsilon) {
  // Beyond the last step energies are those of the last one: the Gaussian is up to ε/9 there.
  constexpr double kRounding = 0.005;
  const double last = std::log1p(1.0 / 9);
  const double near = -std::log(measurement(std::max(0.0, residual - reach), sigma, epsilon));
  const double far = -std::log(measurement(residual + reach, sigma, epsilon));
  return {near - kRounding - last, far + kRounding};
}

TEST(CombinedCost, IsTheEquation) {
  for (const Case& made : kCases) {
    const double epsilon = std::max(made.epsilon, kMinCombinedEpsilon);
    for (const CombinedCells meaning : {CombinedCells::kEnergy, CombinedCells::kLikelihood}) {
      for_each_rows([&](const CombinedRow& row) {
        const CombinedModel model =
            combined_model(made.sigmas, made.epsilon, row.levels.channels, meaning);
        const auto cells = row_on_every_target<float>(
            cell_count(row.levels), [&](float* out) { combined_row(row, model, meaning, out); });
        for (int j = 0; j < row.levels.columns; ++j) {
          for (int i = 0; i < row.levels.lanes; ++i) {
            const int k = j * row.levels.partner_step + i;
            const double cell = cells[j * row.levels.lanes + i];
            if (meaning == CombinedCells::kLikelihood && i >= row.levels.count) {
              ASSERT_EQ(cell, 0);
              continue;
            }
            // Half a step: up to 0.062 σ or, where that is less, one of the levels'.
            const auto reach = [](double sigma) { return std::max(0.062 * sigma, 1.0 / 32); };
            const auto [sigma_grey, sigma_census, sigma_gradient] = made.sigmas;
            Bounds sum = energy_bounds(grey_residual(row.levels, j, k), reach(sigma_grey),
                                       sigma_grey, epsilon);
            const auto add = [&](const Bounds& term) {
              sum.min += term.min;
              sum.max += term.max;
            };
            if (sigma_census > 0) {
              add(energy_bounds(census_residual(row.codes, j, k), 0, sigma_census, epsilon));
            }
            if (sigma_gradient > 0) {
              add(energy_bounds(gradient_residual(row.gradients, j, k), reach(sigma_gradient),
                                sigma_gradient, epsilon));
            }
            const double energy = meaning == CombinedCells::kEnergy ? cell : -std::log(cell);
            ASSERT_GE(energy, sum.min) << "column " << j << ", lane " << i;
            ASSERT_LE(energy, sum.max) << "column " << j << ", lane " << i;
          }
        }
      });
    }
  }
}

TEST(CombinedModel, CensusIsTheEquationExactly) {
  const CombinedModel energies = combined_model({5, .2, 0}, .1, 1, CombinedCells::kEnergy);
  const CombinedModel likelihoods = combined_model({5, .2, 0}, .1, 1, CombinedCells::kLikelihood);
  for (std::size_t bits = 0; bits <= 62; ++bits) {
    const auto value_of = [&](const TermTable& table) {
      return table.low[bits] | static_cast<std::uint32_t>(table.high[bits]) << 8U;
    };
    const double p = measurement(static_cast<double>(bits) / 62, .2, .1);
    EXPECT_NEAR(value_of(energies.census.table) / 512.0, -std::log(p), 0.5 / 512 + 1e-9) << bits;
    EXPECT_NEAR(std::bit_cast<float>(value_of(likelihoods.census.table) << 16U), p, p / 256)
        << bits;
  }
}

TEST(CombinedModel, StepsAreFineAndReachToWhereOnlyOutliersAre) {
  for (const double epsilon : {.3, .1, .01, 1e-4, 1e-12}) {
    for (const double sigma : {1., 3., 5., 12.}) {
      const CombinedModel model = combined_model({sigma, 0, 0}, epsilon, 1, CombinedCells::kEnergy);
      const double step_levels = 65536.0 / model.grey.multiplier / kFixedPerIntensity;
      EXPECT_LE(step_levels, 0.13 * sigma);
      const double p = measurement(64 * step_levels, sigma, epsilon);
      EXPECT_LE(p, 1.08 * epsilon);
    }
  }
}

}  // namespace vantage::kernels::combined_cost_test
