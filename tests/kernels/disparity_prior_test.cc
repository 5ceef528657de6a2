#include "kernels/disparity_prior/disparity_prior.h"

#include "tests/kernels/kernel_test_utils.h"

namespace vantage::kernels::disparity_prior_test {

constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// Cells with fractions; those behind the last candidate are extreme in energies, 0 in likelihoods.
struct PriorCase {
  DisparityPriorRow row;
  std::vector<float> prior_px;
  std::vector<float> cells;

  PriorCase(std::mt19937& random, int columns, int lanes, bool likelihoods) {
    row.columns = columns;
    row.lanes = lanes;
    row.count = random_int(random, std::max(1, lanes - 20), lanes);
    row.disparity_min = random_int(random, -30, 30);
    row.steps_per_px = 1 << (lanes / 16 + columns) % 3;
    const float weights[] = {0, 0.3F, 1, 7, 100};
    row.weight = weights[random() % std::size(weights)];
    row.max_contrast = random() % 3 == 0 ? 20.0F : kInfinity;
    for (int j = 0; j < columns; ++j) {
      const int offset = random_int(random, -40, row.count * 10 + 30);
      const float wild[] = {kUnknown, kInfinity, -kInfinity};
      prior_px.push_back(random() % 6 == 0 ? wild[random() % 3]
                                           : (static_cast<float>(row.disparity_min) +
                                              static_cast<float>(offset) / 10) /
                                                 static_cast<float>(row.steps_per_px));
      for (int i = 0; i < lanes; ++i) {
        const float cell = static_cast<float>(random() % 10001U) / (likelihoods ? 1e4F : 30.0F);
        cells.push_back(i < row.count ? cell - (likelihoods ? 0.0F : 90.0F)
                        : likelihoods ? 0.0F
                                      : -1e6F);
      }
    }
    row.prior_px = prior_px.data();
  }
  [[nodiscard]] const float* column(int j) const {
    return cells.data() + static_cast<std::ptrdiff_t>(j) * row.lanes;
  }
};

template <typename Body>
void for_each_case(bool likelihoods, const Body& body) {
  std::mt19937 random(71);
  for (const int lanes : kLaneCounts) {
    for (const int columns : {1, 2, 7, 40}) {
      const PriorCase test(random, columns, lanes, likelihoods);
      body(test);
      if (::testing::Test::HasFatalFailure()) {
        return;
      }
    }
  }
}

/// `of_candidate`(cell, shares, mean above least) in double.
template <typename Expected>
void expect_definition(bool likelihoods, const Expected& of_candidate) {
  for_each_case(likelihoods, [&](const PriorCase& test) {
    const auto cells = row_on_every_target<float>(test.cells.size(), [&](float* out) {
      std::copy(test.cells.begin(), test.cells.end(), out);
      (likelihoods ? likelihoods_with_prior_row : energies_with_prior_row)(test.row, out);
    });
    for (int j = 0; j < test.row.columns; ++j) {
      const float* before = test.column(j);
      const double offset =
          double{test.prior_px[j]} * test.row.steps_per_px - test.row.disparity_min;
      const bool has_prior = offset >= 0 && offset <= test.row.count - 1;
      double contrast = 0;
      for (int i = 0; i < test.row.count; ++i) {
        contrast += double{before[i]} / test.row.count;
      }
      contrast -= *std::min_element(before, before + test.row.count);
      for (int i = 0; i < test.row.lanes; ++i) {
        const float actual = cells[j * test.row.lanes + i];
        if (!has_prior) {
          ASSERT_EQ(actual, before[i]);
        } else if (i < test.row.count) {
          const double k_px = (i - offset) / test.row.steps_per_px;
          const double share = std::min(1.0, k_px * k_px / 4);
          const double expected = of_candidate(test.row, before[i], share, contrast);
          ASSERT_NEAR(actual, expected, 2e-5 * std::max(1.0, std::abs(expected)))
              << "column " << j << ", candidate " << i << " of " << test.row.count;
        } else if (likelihoods) {
          ASSERT_EQ(actual, 0);
        } else {
          ASSERT_TRUE(std::isfinite(actual));
        }
      }
    }
  });
}

double energy(const DisparityPriorRow& row, double cell, double share, double contrast) {
  return cell + row.weight * std::min<double>(contrast, row.max_contrast) * share;
}
double likelihood(const DisparityPriorRow& row, double cell, double share, double /*contrast*/) {
  return cell * std::exp(std::max<double>(-row.weight, -20 * std::log(2.0)) * share);
}

TEST(DisparityPrior, FollowsTheDefinitions) {
  expect_definition(false, energy);
  expect_definition(true, likelihood);
}

VANTAGE_ON_EVERY_TARGET(DisparityPrior);

/// Cells of a part of the candidates become what they become among all of them.
TEST_P(DisparityPrior, LikelihoodsOfSomeCandidatesAreThoseOfAll) {
  for_each_case(true, [](const PriorCase& all) {
    std::vector<float> expected = all.cells;
    likelihoods_with_prior_row(all.row, expected.data());
    for (int first = 0; first < all.row.lanes; first += kLaneMultiple) {
      DisparityPriorRow row = all.row;
      row.lanes = kLaneMultiple;
      row.first_candidate = first;
      std::vector<float> cells;
      std::vector<float> part;
      for (int j = 0; j < row.columns; ++j) {
        const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(j) * all.row.lanes + first;
        cells.insert(cells.end(), all.cells.begin() + at, all.cells.begin() + at + kLaneMultiple);
        part.insert(part.end(), expected.begin() + at, expected.begin() + at + kLaneMultiple);
      }
      likelihoods_with_prior_row(row, cells.data());
      ASSERT_EQ(cells, part);
    }
  });
}

TEST_P(DisparityPrior, KeepsTheVertexOfAParabola) {
  // Cells without preference near the prior: a parabola through the least cell and its neighbours
  // has its vertex where the prior is.
  for (const float prior_px : {7.0F, 7.25F, 6.6F, 7.49F}) {
    std::vector<float> cells(16, 3.0F);
    cells[0] = 0;
    cells[15] = 40;
    DisparityPriorRow row;
    row.prior_px = &prior_px;
    row.columns = 1;
    row.lanes = row.count = 16;
    energies_with_prior_row(row, cells.data());
    const double below = cells[6];
    const double at = cells[7];
    const double above = cells[8];
    EXPECT_NEAR(7 + (below - above) / (2 * (below - 2 * at + above)), prior_px, 1e-5);
  }
}

}  // namespace vantage::kernels::disparity_prior_test
