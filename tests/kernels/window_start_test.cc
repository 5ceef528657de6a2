#include "kernels/window_start/window_start.h"

#include <array>

#include "tests/kernels/kernel_test_utils.h"

namespace vantage::kernels::window_start_test {

VANTAGE_ON_EVERY_TARGET(WindowStart);

TEST_P(WindowStart, EqualsReference) {
  std::mt19937 random(3);
  for (int columns = 1; columns <= 40; ++columns) {
    const auto size = static_cast<std::size_t>(columns + kWindowMargin);
    std::vector<WindowCells> energies(size);
    std::vector<std::uint8_t> offset_bits(size);
    for (std::size_t x = 0; x < size; ++x) {
      for (int k = 0; k < kWindowCandidates; ++k) {
        energies[x] |= static_cast<WindowCells>(random() % 256) << (8 * k);
      }
      offset_bits[x] = random() % 2 == 0 ? 8 : 0;
    }
    const CoarseEnergies coarse{.spacing = 1 + columns / 2 % 2,
                                .energies = energies.data(),
                                .offset_bits = offset_bits.data(),
                                .steps = static_cast<std::uint16_t>(random_int(random, 1, 1000)),
                                .ceiling = static_cast<std::uint8_t>(random_int(random, 1, 255)),
                                .lanes = columns % 3 == 0 ? WindowCells{0xFFFF} : ~WindowCells{0},
                                .columns = columns};
    std::vector<WindowCells> support(size), expected(size);
    window_start_row(coarse, support.data());
    window_start_row_ref(coarse, expected.data());
    support.resize(columns);
    expected.resize(support.size());
    EXPECT_EQ(support, expected);
  }
}

TEST_P(WindowStart, InterpolatesBetweenCoarseCandidates) {
  // Energies 10, 21, 30, … at every second candidate, the window beginning after the first.
  const WindowCells energies = 0xFF'FF'3C'32'28'1E'15'0A;
  const std::uint8_t offset_bits[kWindowMargin] = {8};
  const WindowCells padded[kWindowMargin] = {energies};
  WindowCells support[1 + kWindowMargin] = {};
  window_start_row({.energies = padded, .offset_bits = offset_bits, .ceiling = 100, .columns = 1},
                   support);
  const std::array<int, kWindowCandidates> expected = {84, 79, 74, 70, 65, 60, 55, 50};
  for (int k = 0; k < kWindowCandidates; ++k) {
    EXPECT_EQ(window_cell(support[0], k), expected[k]) << k;
  }
}

TEST_P(WindowStart, SecondWinnersEqualReference) {
  std::mt19937 random(5);
  for (int columns = 1; columns <= 50; ++columns) {
    const auto size = static_cast<std::size_t>(columns + 2 * kWindowMargin);
    std::array<std::vector<std::int16_t>, 3> winners;
    for (auto& row : winners) {
      row.resize(size);
      for (std::int16_t& winner : row) {
        winner = static_cast<std::int16_t>(random() % 8 == 0 ? random_int(random, 0, 4000)
                                                             : random_int(random, 30, 32));
      }
    }
    const std::array<const std::int16_t*, 3> rows = {winners[0].data() + kWindowMargin,
                                                     winners[1].data() + kWindowMargin,
                                                     winners[2].data() + kWindowMargin};
    std::vector<std::int16_t> second(size), expected(size);
    second_winners_row(rows, columns, second.data());
    second_winners_row_ref(rows, columns, expected.data());
    second.resize(columns);
    expected.resize(second.size());
    EXPECT_EQ(second, expected);
  }
}

}  // namespace vantage::kernels::window_start_test
