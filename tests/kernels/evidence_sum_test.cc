#include "kernels/evidence_sum/evidence_sum.h"

#include "tests/kernels/evidence_norms.h"
#include "tests/kernels/kernel_test_utils.h"

namespace vantage::kernels::evidence_sum_test {

/// Random gradients; NaN where rows are read but not counted.
struct RandomGradients {
  RandomGradients(std::mt19937& random, int columns, int rows, std::size_t offset)
      : stride((columns + kLaneMultiple - 1) / kLaneMultiple * kLaneMultiple),
        x(static_cast<std::size_t>(stride * rows), offset),
        y(x.size(), offset + 1),
        half_norm(x.size(), offset + 2) {
    for (std::size_t i = 0; i < x.size(); ++i) {
      const bool counted = static_cast<int>(i) % stride < columns;
      x[i] = counted ? static_cast<float>(random_int(random, -2550, 2550)) / 10
                     : std::numeric_limits<float>::quiet_NaN();
      y[i] = static_cast<float>(random_int(random, -2550, 2550)) / 10;
      half_norm[i] = std::hypot(x[i], y[i]) / 2;
    }
  }
  [[nodiscard]] GradientBlock block() const {
    return {x.data(), y.data(), half_norm.data(), stride};
  }

  int stride;
  UnalignedRow<float> x;
  UnalignedRow<float> y;
  UnalignedRow<float> half_norm;
};

double length(double x, double y, EvidenceNorm norm) {
  const double sum = std::abs(x) + std::abs(y);
  const double max = std::max(std::abs(x), std::abs(y));
  return norm == EvidenceNorm::kL2        ? std::sqrt(x * x + y * y)
         : norm == EvidenceNorm::kOctagon ? 0.3978247 * sum + 0.5626091 * max
         : norm == EvidenceNorm::kL1      ? sum
         : norm == EvidenceNorm::kMax     ? max
                                          : std::abs(x);
}

/// The equation in double precision.
double plain_sum(const EvidenceBlock& block) {
  double sum = 0;
  for (int row = 0; row < block.rows; ++row) {
    for (int j = 0; j < block.columns; ++j) {
      const auto a = row * block.reference.row_stride + j;
      const auto b = row * block.partner.row_stride + j;
      const double dx = double{block.reference.x[a]} - block.partner.x[b];
      const double dy = double{block.reference.y[a]} - block.partner.y[b];
      sum += double{block.reference.half_norm[a]} + block.partner.half_norm[b] -
             length(dx, dy, block.norm);
    }
  }
  return sum;
}

constexpr int kColumnCounts[] = {0, 1, 2, 15, 16, 17, 31, 32, 33, 61, 64, 67, 128};
constexpr int kRowCounts[] = {0, 1, 2, 16};

TEST(EvidenceSum, IsTheSumOfTheEquation) {
  std::mt19937 random(2);
  for (const int columns : kColumnCounts) {
    for (const int rows : kRowCounts) {
      const RandomGradients reference(random, columns, rows, 1);
      const RandomGradients partner(random, columns, rows, 5);
      for (const EvidenceNorm norm : kAllEvidenceNorms) {
        const EvidenceBlock block = {reference.block(), partner.block(), columns, rows, norm};
        const double sum = evidence_sum(block);
        EXPECT_NEAR(sum, plain_sum(block), 1e-3 * (1 + columns * rows));
        for_each_target([&] { EXPECT_EQ(evidence_sum(block), sum) << columns << 'x' << rows; });
      }
    }
  }
}

TEST(EvidenceSum, EqualGradientsSupportWithTheirNorm) {
  std::mt19937 random(3);
  const RandomGradients gradients(random, 77, 3, 0);
  double norms = 0;
  for (int row = 0; row < 3; ++row) {
    for (int j = 0; j < 77; ++j) {
      norms += 2 * gradients.half_norm[row * gradients.stride + j];
    }
  }
  EXPECT_NEAR(evidence_sum({gradients.block(), gradients.block(), 77, 3}), norms, 1e-2);
}

}  // namespace vantage::kernels::evidence_sum_test
