#include "kernels/census/census.h"

#include <cstdlib>

#include "kernels/candidates.h"
#include "tests/kernels/feature_rows.h"
#include "tests/kernels/kernel_test_utils.h"

namespace vantage::kernels::census_test {

VANTAGE_ON_EVERY_TARGET(Census);

/// Seven rows of few grey levels, so that many neighbours are equal.
struct Window {
  explicit Window(int width) {
    std::mt19937 random(static_cast<unsigned>(width));
    const auto size = static_cast<std::size_t>((width + 15) / 16 * 16) + 2 * kCensusRadiusX;
    for (std::size_t v = 0; v < rows.size(); ++v) {
      memory.emplace_back(size, random() % 5);
      for (std::size_t k = 0; k < size; ++k) {
        memory.back()[k] = static_cast<float>(random() % 8) / 2;
      }
      rows[v] = memory.back().data() + kCensusRadiusX;
    }
  }
  std::vector<UnalignedRow<float>> memory;
  CensusRows rows{};
};

TEST_P(Census, Codes) {
  for (const int width : {1, 2, 15, 16, 17, 40}) {
    const Window window(width);
    const auto padded = static_cast<std::size_t>((width + 15) / 16 * 16);
    GuardedRow<std::uint32_t> first(padded, 1, 0xABCDU);
    GuardedRow<std::uint32_t> second(padded, 2, 0xABCDU);
    census_code_row(window.rows, width, first.data(), second.data());
    for (int x = 0; x < width; ++x) {
      const auto k = static_cast<std::size_t>(x);
      // Bit by bit, in reading order.
      int bit = 0;
      for (int v = 0; v < 7; ++v) {
        for (int u = -4; u <= 4; ++u) {
          if (v == 3 && u == 0) {
            continue;
          }
          const float* row = window.rows[v];
          const std::uint32_t half = (bit < 31 ? first : second).data()[k];
          ASSERT_EQ((half >> (30 - bit % 31)) & 1U, row[x + u] < window.rows[3][x] ? 1U : 0U)
              << "row " << v << ", column " << u;
          ++bit;
        }
      }
      ASSERT_EQ(bit, 62);
    }
    EXPECT_TRUE(first.intact());
    EXPECT_TRUE(second.intact());
  }
}

TEST_P(Census, RayCodes) {
  // Up, down, left, right and along diagonals, as the header says.
  const auto is_neighbour = [](int u, int v) {
    const bool is_straight = (u == 0) != (v == 0);
    return is_straight || (std::abs(u) == std::abs(v) && (std::abs(u) == 1 || std::abs(u) == 2));
  };
  for (const int width : {1, 2, 15, 16, 17, 40}) {
    const Window window(width);
    const RayCensusRows rows = {window.rows[0], window.rows[1], window.rows[2],
                                window.rows[3], window.rows[4], window.rows[5],
                                window.rows[6], window.rows[1], window.rows[3]};
    for (const int thresholds : {1, 3}) {
      const std::size_t bytes = thresholds == 1 ? 3 : 6;
      const auto padded = static_cast<std::size_t>((width + 15) / 16 * 16);
      std::vector<GuardedRow<std::uint8_t>> codes;
      RayCensusCodes out{};
      codes.reserve(bytes);
      for (std::size_t p = 0; p < bytes; ++p) {
        codes.emplace_back(padded, p, std::uint8_t{0xAB});
        out[p] = codes[p].data();
      }
      ray_census_code_row(rows, width, thresholds, out);
      for (int x = 0; x < width; ++x) {
        const auto k = static_cast<std::size_t>(x);
        std::size_t bit = 0;
        for (int v = -4; v <= 4; ++v) {
          for (int u = -4; u <= 4; ++u) {
            if (!is_neighbour(u, v)) {
              continue;
            }
            const float more = rows[4 + v][x + u] - rows[4][x];
            const auto bit_of = [&](std::size_t first) {
              return (out[first + bit / 8][k] >> (7 - bit % 8)) & 1;
            };
            SCOPED_TRACE(testing::Message() << "column " << u << ", row " << v);
            if (thresholds == 1) {
              ASSERT_EQ(bit_of(0), more < 0 ? 1 : 0);
            } else {
              const int expected = more < -1.25F ? 3 : more < 0 ? 2 : more <= 1.25F ? 1 : 0;
              ASSERT_EQ(2 * bit_of(0) + bit_of(3), expected);
            }
            ++bit;
          }
        }
        ASSERT_EQ(bit, 24U);
      }
      for (const auto& of_byte : codes) {
        EXPECT_TRUE(of_byte.intact());
      }
    }
  }
}

TEST_P(Census, HammingDistance) {
  const auto draw = [](std::mt19937& random) -> std::uint32_t {
    switch (random() % 6) {
      case 0:
        return 0;
      case 1:
        return 0xFFFFFFFFU;
      default:
        return static_cast<std::uint32_t>(random());
    }
  };
  for_each_feature_rows<std::uint32_t, 2>(draw, [](const CensusPairs& row) {
    const auto cells = written_row(cell_count(row), -99.0F, hamming_row, row);
    for (int j = 0; j < row.columns; ++j) {
      for (int i = 0; i < row.lanes; ++i) {
        int different = 0;
        for (int c = 0; c < row.channels; ++c) {
          const auto& [a, b] = row.channel[c];
          for (std::size_t p = 0; p < 2; ++p) {
            for (int bit = 0; bit < 32; ++bit) {
              different += static_cast<int>(((a[p][j] >> bit) & 1U) ^
                                            ((b[p][j * row.partner_step + i] >> bit) & 1U));
            }
          }
        }
        ASSERT_FLOAT_EQ(cells[j * row.lanes + i],
                        static_cast<float>(different) / static_cast<float>(row.channels));
      }
    }
  });
}

TEST_P(Census, RayCodesOfBytesEqualThoseOfFloats) {
  std::mt19937 random(12);
  constexpr std::size_t kMargin = 4;
  for (const int width : {1, 5, 16, 17, 63, 64, 65, 130}) {
    const auto size = static_cast<std::size_t>(width);
    const std::size_t read =
        kMargin + (size + kLaneMultiple - 1) / kLaneMultiple * kLaneMultiple + kMargin;
    std::vector<std::vector<std::uint8_t>> bytes(9, std::vector<std::uint8_t>(read));
    std::vector<std::vector<float>> floats(9, std::vector<float>(read));
    ByteRayCensusRows byte_rows{};
    RayCensusRows rows{};
    for (std::size_t r = 0; r < 9; ++r) {
      for (std::size_t x = 0; x < read; ++x) {
        bytes[r][x] = static_cast<std::uint8_t>(random_int(random, 0, 3) * 85);
        floats[r][x] = bytes[r][x];
      }
      byte_rows[r] = bytes[r].data() + kMargin;
      rows[r] = floats[r].data() + kMargin;
    }
    std::vector<std::vector<std::uint8_t>> codes(6, std::vector<std::uint8_t>(read));
    std::vector<std::vector<std::uint8_t>> expected = codes;
    const auto pointers = [](auto& planes) {
      RayCensusCodes of_planes{};
      for (std::size_t p = 0; p < planes.size(); ++p) {
        of_planes[p] = planes[p].data();
      }
      return of_planes;
    };
    byte_ray_census_code_row(byte_rows, width, pointers(codes));
    ray_census_code_row(rows, width, 1, pointers(expected));
    for (std::size_t p = 0; p < kRayCensusBytes; ++p) {
      codes[p].resize(size);
      expected[p].resize(size);
      EXPECT_EQ(codes[p], expected[p]);
    }
  }
}

}  // namespace vantage::kernels::census_test
