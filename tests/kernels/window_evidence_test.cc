#include "kernels/window_evidence/window_evidence.h"

#include <array>

#include "tests/kernels/kernel_test_utils.h"

namespace vantage::kernels::window_evidence_test {

VANTAGE_ON_EVERY_TARGET(WindowEvidence);

/// Random codes and windows.
struct Inputs {
  Inputs(int side, int thresholds, int direction, int columns, std::mt19937& random) {
    constexpr int kCandidates = 40;
    const int pixels = side * (columns + 1);
    for (std::size_t i = 0; i < 2 * kMaxRayCensusBytes; ++i) {
      reference[i].resize(pixels);
      partner[i].resize(pixels + kCandidates + 32);
      for (auto* bytes : {&reference[i], &partner[i]}) {
        for (std::uint8_t& byte : *bytes) {
          // Few bits: distances below and above 16.
          byte = static_cast<std::uint8_t>(random() & (columns % 2 == 0 ? 255U : random()));
        }
      }
      row.reference[i / kMaxRayCensusBytes][i % kMaxRayCensusBytes] = reference[i].data();
      row.partner[i / kMaxRayCensusBytes][i % kMaxRayCensusBytes] =
          partner[i].data() + (direction > 0 ? 8 : kCandidates + 8);
    }
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
    row.side = side;
    row.thresholds = thresholds;
    row.direction = direction;
    row.start = {start[0].data(), start[1].data()};
    row.has_second = has_second.data();
    row.columns = columns;
  }
  Inputs(const Inputs&) = delete;
  Inputs& operator=(const Inputs&) = delete;

  std::array<std::vector<std::uint8_t>, 2 * kMaxRayCensusBytes> reference, partner;
  std::array<std::vector<std::int16_t>, kWindows> start;
  std::vector<std::uint8_t> has_second;
  WindowEvidenceRow row;
};

TEST_P(WindowEvidence, EqualsReference) {
  std::mt19937 random(17);
  for (const int side : {1, 2}) {
    for (const int thresholds : {1, 3}) {
      for (int columns = 1; columns <= 20; ++columns) {
        const Inputs inputs(side, thresholds, columns % 4 < 2 ? 1 : -1, columns, random);
        ByteByDistance by_distance;
        // Tables that end early need fewer lookups.
        by_distance.last = std::min(ray_census_distances(thresholds) - 1, 4 * columns);
        for (std::size_t distance = 0; distance < by_distance.steps.size(); ++distance) {
          by_distance.steps[distance] = distance > static_cast<std::size_t>(by_distance.last)
                                            ? by_distance.steps[distance - 1]
                                            : static_cast<std::uint8_t>(random_int(
                                                  random, 0, side == 1 ? 255 : kMaxPixelEvidence));
        }
        std::array<std::vector<WindowCells>, kWindows> evidence, expected;
        for (std::size_t q = 0; q < kWindows; ++q) {
          evidence[q].resize(columns);
          expected[q].resize(columns);
        }
        window_evidence_row(inputs.row, by_distance, {evidence[0].data(), evidence[1].data()});
        window_evidence_row_ref(inputs.row, by_distance, {expected[0].data(), expected[1].data()});
        EXPECT_EQ(evidence, expected)
            << side << " pixels, " << thresholds << " thresholds, " << columns << " columns";
      }
    }
  }
}

}  // namespace vantage::kernels::window_evidence_test
