#include "engine/evaluation/membrane_support.h"

#include "tests/engine/engine_test.h"

namespace vantage::membrane_support_test {

TEST(MembraneSupport, SolvesTheDiscreteEquation) {
  // (6.10): β (δ − f) + Σ over N4 (f_n − f) = 0 at every offset.
  for (const double beta : {0.1, 0.5, 0.7, 2.0}) {
    const SupportFunction support = membrane_support(beta, 12);
    for (int dy = -11; dy <= 11; ++dy) {
      for (int dx = -11; dx <= 11; ++dx) {
        const double here = support.at(dx, dy);
        const double change = beta * ((dx == 0 && dy == 0 ? 1 : 0) - here) +
                              support.at(dx + 1, dy) + support.at(dx - 1, dy) +
                              support.at(dx, dy + 1) + support.at(dx, dy - 1) - 4 * here;
        EXPECT_NEAR(change, 0, 1e-12);
      }
    }
  }
}

TEST(MembraneSupport, SumsToOneAndIsSymmetric) {
  const SupportFunction support = membrane_support(0.7, 60);
  EXPECT_NEAR(support.sum(), 1, 1e-9);
  EXPECT_NEAR(support.at(3, 5), support.at(-5, 3), 1e-14);
  EXPECT_GT(support.at(0, 0), support.at(1, 0));
  EXPECT_GT(support.at(1, 0), support.at(1, 1));
}

TEST(MembraneSupport, IsWhatManyIterationsConvergeTo) {
  for (const double beta : {0.3, 0.7}) {
    const SupportFunction limit = membrane_support(beta, 40);
    for (const double lambda : {0.1, 0.15}) {
      EXPECT_LT(largest_difference(limit, membrane_impulse_response(beta, lambda, 400, 40)), 1e-6);
    }
    EXPECT_GT(largest_difference(limit, membrane_impulse_response(beta, 0.15, 3, 40)), 1e-3);
  }
}

TEST(MembraneSupport, FirstIterationsByHand) {
  const SupportFunction none = membrane_impulse_response(0.5, 0.15, 0, 2);
  EXPECT_EQ(none.at(0, 0), 1);
  EXPECT_EQ(none.sum(), 1);
  const SupportFunction one = membrane_impulse_response(0.5, 0.15, 1, 2);
  EXPECT_NEAR(one.at(0, 0), 0.4, 1e-15);
  EXPECT_NEAR(one.at(0, -1), 0.15, 1e-15);
  EXPECT_EQ(one.at(1, 1), 0);
}

TEST(MembraneSupport, RefusesWhatDoesNotConverge) {
  EXPECT_THROW(membrane_support(0, 5), UsageError);
  EXPECT_THROW(membrane_support(0.5, 0), UsageError);
  EXPECT_THROW(membrane_impulse_response(0.5, 0.23, 5, 5), UsageError);
  EXPECT_THROW(membrane_impulse_response(0.5, 0.15, -1, 5), UsageError);
}

}  // namespace vantage::membrane_support_test
