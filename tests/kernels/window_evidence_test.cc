#include "kernels/window_evidence/window_evidence.h"

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include "tests/kernels/kernel_test_utils.h"

namespace vantage::kernels {
namespace window_evidence_test {

class WindowEvidence : public EveryTarget {};
VANTAGE_ON_EVERY_TARGET(WindowEvidence);

TEST_P(WindowEvidence, EqualsReference) {
  std::mt19937 random(17);
  constexpr int kCandidates = 40;
  for (int columns = 1; columns <= 20; ++columns) {
    for (const int direction : {1, -1}) {
      const int pixels = 2 * columns;
      const auto partner_size = static_cast<std::size_t>(pixels + kCandidates + 32);
      std::vector<std::vector<std::uint8_t>> reference(6), partner(6);
      WindowEvidenceRow row;
      for (std::size_t i = 0; i < 6; ++i) {
        reference[i].resize(static_cast<std::size_t>(pixels));
        partner[i].resize(partner_size);
        for (auto* bytes : {&reference[i], &partner[i]}) {
          for (std::uint8_t& byte : *bytes) {
            // Few bits: distances below and above 16.
            byte = static_cast<std::uint8_t>(random() & (columns % 2 == 0 ? 255U : random()));
          }
        }
        row.reference[i / 3][i % 3] = reference[i].data();
        row.partner[i / 3][i % 3] = partner[i].data() + (direction > 0 ? 8 : kCandidates + 8);
      }
      std::array<std::vector<std::int16_t>, kWindows> start;
      std::vector<std::uint8_t> has_second;
      for (int x = 0; x < columns; ++x) {
        if (x % 2 == 1) {
          start[0].push_back(start[0].back());
          start[1].push_back(start[1].back());
          has_second.push_back(has_second.back());
          continue;
        }
        start[0].push_back(static_cast<std::int16_t>(random_int(random, 0, kCandidates - 8)));
        start[1].push_back(static_cast<std::int16_t>(random_int(random, 0, kCandidates - 8)));
        has_second.push_back(random() % 3 == 0 ? 255 : 0);
      }
      row.direction = direction;
      row.start = {start[0].data(), start[1].data()};
      row.has_second = has_second.data();
      row.columns = columns;
      EvidenceByDistance by_distance;
      for (std::size_t distance = 0; distance <= kRayCensusNeighbours; ++distance) {
        by_distance.steps[distance] =
            static_cast<std::uint8_t>(random_int(random, 0, kMaxPixelEvidence));
      }
      std::array<std::vector<WindowCells>, kWindows> evidence, expected;
      for (std::size_t q = 0; q < kWindows; ++q) {
        evidence[q].resize(static_cast<std::size_t>(columns));
        expected[q].resize(static_cast<std::size_t>(columns));
      }
      window_evidence_row(row, by_distance, {evidence[0].data(), evidence[1].data()});
      window_evidence_row_ref(row, by_distance, {expected[0].data(), expected[1].data()});
      EXPECT_EQ(evidence, expected);
    }
  }
}

}  // namespace window_evidence_test
}  // namespace vantage::kernels
