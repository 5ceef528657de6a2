#include "kernels/column_sum/column_sum.h"

#include <utility>

#include "tests/kernels/kernel_test_utils.h"

namespace vantage::kernels::column_sum_test {

VANTAGE_ON_EVERY_TARGET(ColumnSumOn);

constexpr std::int32_t kSentinel = -0x5A5A5A5B;
constexpr int kCounts[] = {16, 32, 48, 64, 80, 144, 272};

/// A quantisation and the costs it takes; units of a quarter make ties.
struct Quantisation {
  float offset;
  float scale;
};
constexpr Quantisation kQuantisations[] = {{0, 1}, {0.5F, 2}, {1000, 1024}, {-3, 0.25F}};

/// A cost whose quantised value lies anywhere in [0, 2²²), often half way between two integers.
float draw_cost(std::mt19937& random, const Quantisation& quantisation) {
  const int kind = random_int(random, 0, 3);
  const int max = kind == 0 ? 4 * 4194304 - 1 : 400;
  const auto quarters = static_cast<double>(random_int(random, 0, max));
  return static_cast<float>(quarters / 4 / quantisation.scale - quantisation.offset);
}

std::int64_t quantised(float cost, const Quantisation& quantisation) {
  const float shifted = cost + quantisation.offset;  // rounded as costs are
  const double value = static_cast<double>(shifted) * quantisation.scale;
  const double below = std::floor(value);
  const double rest = value - below;
  const auto integer = static_cast<std::int64_t>(below);
  return rest > 0.5 || (rest == 0.5 && integer % 2 != 0) ? integer + 1 : integer;
}

TEST_P(ColumnSumOn, MovesSumsByOneRow) {
  std::mt19937 random(41);
  for (const int count : kCounts) {
    for (const Quantisation& quantisation : kQuantisations) {
      for (const auto& [enters, leaves] :
           {std::pair{true, true}, {true, false}, {false, true}, {false, false}}) {
        SCOPED_TRACE(testing::Message() << count << " cells, scale " << quantisation.scale
                                        << ", entering " << enters << ", leaving " << leaves);
        const auto size = static_cast<std::size_t>(count);
        UnalignedRow<float> entering(size, random() % 5);
        UnalignedRow<float> leaving(size, random() % 5);
        std::vector<std::int32_t> previous(size);
        std::vector<std::int32_t> expected(size);
        for (std::size_t i = 0; i < size; ++i) {
          entering[i] = draw_cost(random, quantisation);
          leaving[i] = draw_cost(random, quantisation);
          previous[i] = static_cast<std::int32_t>(random());
          expected[i] =
              modulo_32_bits(previous[i] + (enters ? quantised(entering[i], quantisation) : 0) -
                             (leaves ? quantised(leaving[i], quantisation) : 0));
        }
        const ColumnSum row = {enters ? entering.data() : nullptr,
                               leaves ? leaving.data() : nullptr, quantisation.offset,
                               quantisation.scale, count};
        GuardedRow<std::int32_t> sums(size, 3, kSentinel);
        column_sum_row(row, previous.data(), sums.data());
        ASSERT_EQ(sums.values(), expected);
        ASSERT_TRUE(sums.intact());
        column_sum_row(row, previous.data(), previous.data());
        ASSERT_EQ(previous, expected) << "in place";
      }
    }
  }
}

}  // namespace vantage::kernels::column_sum_test
