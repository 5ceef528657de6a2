#include "kernels/pair_reduction/pair_reduction.h"

#include "kernels/compact_likelihoods/compact_likelihoods.h"
#include "tests/kernels/kernel_test_utils.h"

namespace vantage::kernels::pair_reduction_test {

constexpr std::uint8_t kWithoutPartner = 31;

/// Two rows of energies of both images, each made from the energies of pairs of pixels.
struct PairCase {
  CandidateGeometry geometry;
  std::vector<std::uint8_t> left[2];
  std::vector<std::uint8_t> right[2];

  PairCase(std::mt19937& random, int width, int disparity_min, int count)
      : geometry{.width = width, .disparity_min = disparity_min, .count = count} {
    const int lanes = geometry.lanes();
    const auto cells = static_cast<std::size_t>(width * lanes);
    for (int row = 0; row < 2; ++row) {
      left[row].assign(cells, 255);
      right[row].assign(cells, 255);
      for (int x = 0; x < width; ++x) {
        for (int k = 0; k < count; ++k) {
          const auto cell = static_cast<std::size_t>(x * lanes + k);
          left[row][cell] = right[row][cell] = kWithoutPartner;
        }
      }
      for (int x = 0; x < width; ++x) {
        for (int other = 0; other < width; ++other) {
          const int k = x - other - disparity_min;
          const auto energy = static_cast<std::uint8_t>(random() % 256);
          if (k >= 0 && k < count) {
            left[row][x * lanes + k] = energy;
            right[row][other * lanes + k] = energy;
          }
        }
      }
    }
  }

  [[nodiscard]] BlockRow<std::uint8_t> blocks(const std::vector<std::uint8_t> (&rows)[2]) const {
    return {.upper = rows[0].data(),
            .lower = rows[1].data(),
            .columns = geometry.width,
            .lanes = geometry.lanes()};
  }
};

VANTAGE_ON_EVERY_TARGET(PairReduction);

TEST_P(PairReduction, EqualsThatOfEachImage) {
  std::mt19937 random(4);
  for (const int width : {1, 2, 3, 16, 37, 64, 101}) {
    for (const int disparity_min : {-90, -33, -6, -1, 0, 1, 5, 14, 63}) {
      for (const int count : {1, 15, 16, 17, 40, 64, 80, 144}) {
        const int first = std::max(disparity_min, 1 - width);
        const int end = std::min(disparity_min + count, width);
        if (first >= end) {
          continue;
        }
        const PairCase pair(random, width, first, end - first);
        const float weight = random() % 2 == 0 ? 0.6F : 1.0F;
        const int lanes = pair.geometry.lanes();
        std::vector<std::uint16_t> work(pair_row_work(width, lanes, first), 0xABCD);
        const PairRow row{.columns = width,
                          .lanes = lanes,
                          .disparity_min = first,
                          .count = end - first,
                          .without_partner = kWithoutPartner,
                          .weight = weight,
                          .work = work.data()};
        const auto of_left = pair.blocks(pair.left);
        const auto cells = static_cast<std::size_t>(of_left.blocks() * lanes);
        std::vector<std::uint8_t> expected_left(cells);
        std::vector<std::uint8_t> expected_right(cells);
        std::vector<std::uint16_t> lane_sums(lanes);
        reduce_compact_energies_row(of_left, weight, lane_sums.data(), expected_left.data());
        reduce_compact_energies_row(pair.blocks(pair.right), weight, lane_sums.data(),
                                    expected_right.data());
        const std::string what = std::to_string(width) + " columns, disparities from " +
                                 std::to_string(first) + " to " + std::to_string(end - 1);
        {
          GuardedRow<std::uint8_t> left(cells, 1, 77);
          GuardedRow<std::uint8_t> right(cells, 1, 77);
          start_pair_row(row);
          const int part_columns = 2 * random_int(random, 1, 40);
          for (int x = 0; x < width; x += part_columns) {
            const std::ptrdiff_t cell = std::ptrdiff_t{x} * lanes;
            reduce_left_part(row,
                             {.upper = of_left.upper + cell,
                              .lower = of_left.lower + cell,
                              .columns = std::min(part_columns, width - x),
                              .lanes = lanes},
                             x, left.data() + cell / 2);
          }
          reduce_right_row(row, right.data());
          ASSERT_EQ(left.values(), expected_left) << what;
          ASSERT_EQ(right.values(), expected_right) << what;
          EXPECT_TRUE(left.intact() && right.intact());
        }
      }
    }
  }
}

}  // namespace vantage::kernels::pair_reduction_test
