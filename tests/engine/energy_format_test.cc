#include "engine/matching/levels/energy_format.h"

#include "engine/matching/options/method_rules.h"
#include "tests/engine/engine_test.h"

namespace vantage::energy_format_test {

using kernels::FixedEnergy;
using kernels::kMaxEnergy;

MethodParameters parameters_with(double mu, double epsilon_prior, int final_iterations) {
  MethodParameters parameters = book_parameters(MatchMethod::kBayes);
  parameters.prior_smoothing = PriorSmoothing::kMaximum;
  parameters.mu = mu;
  parameters.epsilon_prior = epsilon_prior;
  parameters.final_iterations = final_iterations;
  return parameters;
}

class EnergyFormats : public ::testing::Test {
 protected:
  /// All that validate() lets pass, and what is next to its limits.
  template <typename Check>
  static void for_each(const Check& check) {
    for (const double mu : {1e-9, 0.28, 0.5, 1.0}) {
      for (const double epsilon : {std::numeric_limits<double>::denorm_min(), 5e-309, 1e-300, 1e-30,
                                   5e-6, 0.01, 0.3, 0.5, 0.9, 1 - 1e-9, std::nextafter(1.0, 0.0)}) {
        for (const int final_iterations : {0, 1}) {
          const MethodParameters parameters = parameters_with(mu, epsilon, final_iterations);
          ASSERT_NO_THROW(validate(parameters));
          check(parameters, EnergyFormat(parameters),
                "mu " + std::to_string(mu) + ", epsilon 1e" + std::to_string(std::log10(epsilon)) +
                    ", " + std::to_string(final_iterations) + " final iterations");
        }
      }
    }
  }
};

/// Kernels add up a star without asking whether there is room.
TEST_F(EnergyFormats, HaveRoomForTheLargestSums) {
  for_each(
      [](const MethodParameters& parameters, const EnergyFormat& format, const std::string& what) {
        constexpr double kMaxLikelihoodNats = 87.34;
        const int star =
            5 * kernels::weighted(format.ceiling(),
                                  kernels::fixed_weight(static_cast<float>(parameters.mu)));
        const double source = std::ceil(kMaxLikelihoodNats * format.steps_per_nat());
        EXPECT_LT(star + source + format.ceiling(), kMaxEnergy) << what;
        EXPECT_GT(format.steps_per_nat(), 5) << what;
        EXPECT_LE(format.steps_per_nat(), 256) << what;
      });
}

TEST_F(EnergyFormats, HaveThePriorsCeiling) {
  for_each(
      [](const MethodParameters& parameters, const EnergyFormat& format, const std::string& what) {
        const double epsilon = parameters.epsilon_prior;
        const double nats = std::max(0.0, std::log1p(-epsilon) - std::log(epsilon));
        EXPECT_NEAR(format.ceiling(), nats * format.steps_per_nat(), 0.501) << what;
      });
}

TEST_F(EnergyFormats, RisesGrowAndStayBelowTheCeiling) {
  for_each([](const MethodParameters& /*parameters*/, const EnergyFormat& format,
              const std::string& what) {
    for (const double sigma : {1e-300, 0.1, 0.4, 3.0, 1e300}) {
      FixedEnergy last = 0;
      const auto rises = format.prior_rises(sigma, 300);
      for (const FixedEnergy rise : rises) {
        EXPECT_GE(rise, last) << what;
        EXPECT_LT(rise, format.ceiling()) << what;
        last = rise;
      }
      EXPECT_LT(rises.size(), 300U) << what;
    }
  });
}

/// The last byte of a result is never less than the ceiling, and the ceiling never more than it.
TEST_F(EnergyFormats, ResultsReachTheCeiling) {
  for_each(
      [](const MethodParameters& parameters, const EnergyFormat& format, const std::string& what) {
        constexpr int kLast = kernels::kMaxCompact;
        EXPECT_GE(format.of_result().of(kLast), format.ceiling()) << what;
        for (const int byte : {0, 1, 100, kLast - 1, kLast}) {
          const FixedEnergy energy = format.of_result().of(static_cast<std::uint8_t>(byte));
          EXPECT_NEAR(kernels::weighted(energy, format.result_bytes_per_step()), byte, 1) << what;
        }
        if (parameters.final_iterations == 0) {
          EXPECT_GE(format.of_result().of(kLast), 21.9F * format.steps_per_nat()) << what;
        }
      });
}

TEST(EnergyFormat, OfThePresetsIsTheFinest) {
  const MethodParameters parameters = parameters_with(0.33, 5e-6, 5);
  const EnergyFormat format(parameters);
  EXPECT_EQ(format.steps_per_nat(), 256);
  EXPECT_EQ(format.ceiling(), 3125);  // 256 · ln(1/5e-6 − 1)
}

}  // namespace vantage::energy_format_test
