#include "kernels/evidence/evidence.h"

#include "tests/kernels/evidence_norms.h"
#include "tests/kernels/feature_rows.h"
#include "tests/kernels/kernel_test_utils.h"

namespace vantage::kernels::evidence_test {

float draw_component(std::mt19937& random) {
  return random() % 6 == 0 ? 0 : static_cast<float>(random_int(random, -2550, 2550)) / 10;
}

double norm(double x, double y, EvidenceNorm norm) {
  const double sum = std::abs(x) + std::abs(y);
  const double max = std::max(std::abs(x), std::abs(y));
  switch (norm) {
    case EvidenceNorm::kL2:
      return std::hypot(x, y);
    case EvidenceNorm::kOctagon:
      return .3978247 * sum + .5626091 * max;
    case EvidenceNorm::kL1:
      return sum;
    case EvidenceNorm::kMax:
      return max;
    case EvidenceNorm::kAcross:
      break;
  }
  return std::abs(x);
}

TEST(Evidence, NegatedEvidence) {
  for (const EvidenceNorm of : kAllEvidenceNorms) {
    for_each_feature_rows<float, 3>(draw_component, [&](const GradientPairs& row) {
      const auto cells = row_on_every_target<float>(cell_count(row), negated_evidence_row, row, of);
      for (int j = 0; j < row.columns; ++j) {
        for (int i = 0; i < row.lanes; ++i) {
          const int k = j * row.partner_step + i;
          double sum = 0;
          for (int c = 0; c < row.channels; ++c) {
            const auto& [a, b] = row.channel[c];
            sum += norm(double{a[0][j]} - b[0][k], double{a[1][j]} - b[1][k], of) -
                   (double{a[2][j]} + b[2][k]);
          }
          ASSERT_NEAR(cells[j * row.lanes + i], sum / row.channels, 2e-4);
        }
      }
    });
  }
}

TEST(Evidence, Planes) {
  std::mt19937 random(2);
  for (const EvidenceNorm of : kAllEvidenceNorms) {
    for (const int width : {1, 3, 16, 17, 45}) {
      const auto padded = static_cast<std::size_t>((width + 15) / 16 * 16);
      std::vector<float> gx(padded);
      std::vector<float> gy(padded);
      std::generate(gx.begin(), gx.end(), [&] { return draw_component(random); });
      std::generate(gy.begin(), gy.end(), [&] { return draw_component(random); });
      std::vector<float> x;
      std::vector<float> y;
      const auto half_norm = row_on_every_target<float>(padded, [&](float* out) {
        x = gx;
        y = gy;
        evidence_planes_row({x.data(), y.data(), out, width}, 1.5F, of);
        std::fill(out + width, out + padded, 0.0F);  // anything
      });
      for (std::size_t k = 0; k < static_cast<std::size_t>(width); ++k) {
        ASSERT_FLOAT_EQ(x[k], 1.5F * gx[k]);
        ASSERT_FLOAT_EQ(y[k], 1.5F * gy[k]);
        ASSERT_NEAR(half_norm[k], norm(gx[k], gy[k], of) / 2, 1e-4);
      }
    }
  }
}

// The octagon approximates the L2 norm within 3.96 % (5.17).
TEST(Evidence, OctagonIsNearL2) {
  double worst = 0;
  for (int step = 0; step < 1600; ++step) {
    const double angle = step * 2 * M_PI / 1600;
    std::vector<float> x(16, static_cast<float>(100 * std::cos(angle)));
    std::vector<float> y(16, static_cast<float>(100 * std::sin(angle)));
    std::vector<float> half_norm(16);
    evidence_planes_row({x.data(), y.data(), half_norm.data(), 1}, 1, EvidenceNorm::kOctagon);
    worst = std::max(worst, std::abs(half_norm[0] / 50.0 - 1));
  }
  EXPECT_LE(worst, .0396);
  EXPECT_GE(worst, .039);
}

TEST(Evidence, Likelihood) {
  std::mt19937 random(4);
  const auto draw = [&] { return static_cast<float>(random_int(random, -3000, 3000)) / 10; };
  for (const int direction : {-1, 1}) {
    for (const int count : {1, 5, 16, 17, 64, 75}) {
      for (const int min_disparity : {-40, -3, 0, 30}) {
        for (const int width : {1, 13, 50}) {
          const CandidateGeometry geometry{width, min_disparity, count, direction};
          const int first = random_int(random, 0, width - 1);
          const EvidenceRow row{geometry, first, width - first};
          const auto lanes = static_cast<std::size_t>(geometry.lanes());
          std::vector<float> costs(static_cast<std::size_t>(row.columns) * lanes);
          std::generate(costs.begin(), costs.end(), draw);
          const float sigma = random() % 2 == 0 ? 5.0F : 1e-30F;
          const auto cells = row_on_every_target<float>(costs.size(), [&](float* out) {
            std::copy(costs.begin(), costs.end(), out);
            likelihood_of_evidence(row, sigma, .1F, out);
          });
          for (int j = 0; j < row.columns; ++j) {
            const float* cost = costs.data() + static_cast<std::size_t>(j) * lanes;
            const auto inside = [&](int i) {
              const int partner = first + j + direction * (min_disparity + i);
              return i < count && partner >= 0 && partner < width;
            };
            double max = -std::numeric_limits<double>::infinity();
            for (int i = 0; i < count; ++i) {
              max = inside(i) ? std::max<double>(max, -cost[i]) : max;
            }
            for (int i = 0; i < geometry.lanes(); ++i) {
              const double expected = inside(i)   ? .9 * std::exp((-cost[i] - max) / sigma) + .1
                                      : i < count ? .1
                                                  : 0;
              ASSERT_NEAR(cells[static_cast<std::size_t>(j) * lanes + static_cast<std::size_t>(i)],
                          expected, 1e-6)
                  << "column " << first + j << ", lane " << i;
            }
          }
        }
      }
    }
  }
}

}  // namespace vantage::kernels::evidence_test
