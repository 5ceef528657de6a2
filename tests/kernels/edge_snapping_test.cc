#include "kernels/edge_snapping/edge_snapping.h"

#include <bit>
#include <cstdlib>

#include "tests/kernels/kernel_test_utils.h"

namespace vantage::kernels::edge_snapping_test {

using Row = std::vector<float>;
using Edges = std::vector<std::uint8_t>;

constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

Row snapped(const Edges& edges, int max_px, Row disparity_px) {
  snap_discontinuities_row(edges.data(), max_px, static_cast<int>(disparity_px.size()),
                           disparity_px.data());
  return disparity_px;
}

/// Bits, so that unknown values compare.
std::vector<std::uint32_t> bits(const Row& values) {
  std::vector<std::uint32_t> result;
  for (const float value : values) {
    result.push_back(std::bit_cast<std::uint32_t>(value));
  }
  return result;
}

TEST(EdgeSnapping, MovesToTheNearestEdge) {
  const auto moved = [](const Edges& edges, int max_px) {
    return snapped(edges, max_px, {2, 2, 2, 2, 7, 7, 7, 7});
  };
  // Places are numbered by the column left of them: the jump is at 3, edge 6 is adjacent to 5
  // and 6.
  EXPECT_EQ(moved({0, 0, 0, 0, 0, 0, 9, 0}, 4), (Row{2, 2, 2, 2, 2, 2, 7, 7}));
  EXPECT_EQ(moved({0, 9, 0, 0, 0, 0, 0, 0}, 4), (Row{2, 2, 7, 7, 7, 7, 7, 7}));
  // Out of reach.
  EXPECT_EQ(moved({0, 0, 0, 0, 0, 0, 9, 0}, 1), (Row{2, 2, 2, 2, 7, 7, 7, 7}));
  EXPECT_EQ(moved({0, 0, 0, 0, 0, 0, 9, 0}, 2), (Row{2, 2, 2, 2, 2, 2, 7, 7}));
  // Two as near: the left one.
  EXPECT_EQ(moved({0, 9, 0, 0, 0, 0, 9, 0}, 4), (Row{2, 2, 7, 7, 7, 7, 7, 7}));
  // On an edge already, on either side of it.
  EXPECT_EQ(moved({0, 0, 9, 9, 0, 0, 9, 0}, 4), (Row{2, 2, 2, 2, 7, 7, 7, 7}));
  EXPECT_EQ(moved({0, 0, 9, 0, 9, 0, 9, 0}, 4), (Row{2, 2, 2, 2, 7, 7, 7, 7}));
}

TEST(EdgeSnapping, TakesTheValueBesideTheDiscontinuity) {
  // Slanted surfaces: what passes is one value, that of the column beside the jump.
  EXPECT_EQ(snapped({0, 0, 0, 0, 0, 0, 9, 0}, 4, {1, 1.5F, 2, 2.5F, 9, 8.5F, 8, 7.5F}),
            (Row{1, 1.5F, 2, 2.5F, 2.5F, 2.5F, 8, 7.5F}));
  EXPECT_EQ(snapped({9, 0, 0, 0, 0, 0, 0, 0}, 4, {1, 1.5F, 2, 2.5F, 9, 8.5F, 8, 7.5F}),
            (Row{1, 9, 9, 9, 9, 8.5F, 8, 7.5F}));
}

TEST(EdgeSnapping, OnePixelIsNoJumpAndUnknownIsNone) {
  const Row slope = {1, 2, 3, 2, 1, 0};
  EXPECT_EQ(snapped({0, 9, 0, 0, 9, 0}, 4, slope), slope);
  const Row gap = {1, 1, kUnknown, 9, 9, 9};
  EXPECT_EQ(bits(snapped({9, 0, 0, 0, 0, 9}, 4, gap)), bits(gap));
}

TEST(EdgeSnapping, NeverCrossesUnknownPixels) {
  const Row row = {1, kUnknown, 1, 9, 9, kUnknown, 9};
  EXPECT_EQ(bits(snapped({9, 0, 0, 0, 0, 0, 9}, 6, row)), bits(row));
  // Up to them it may go: place 1 is between the unknown column 1 and column 2.
  EXPECT_EQ(bits(snapped({0, 9, 0, 0, 0, 0, 0}, 6, row)),
            bits({1, kUnknown, 9, 9, 9, kUnknown, 9}));
}

TEST(EdgeSnapping, NeverCrossesOrMeetsAnotherDiscontinuity) {
  // Jumps at 2 and 3; the edge of column 6 draws both: the first stays, where it is next to the
  // second, which goes to 5.
  EXPECT_EQ(snapped({0, 0, 0, 0, 0, 0, 9, 0}, 6, {1, 1, 1, 5, 9, 9, 9, 9}),
            (Row{1, 1, 1, 5, 5, 5, 9, 9}));
  // The edge of column 0 draws both, the first goes.
  EXPECT_EQ(snapped({9, 0, 0, 0, 0, 0, 0, 0}, 6, {1, 1, 1, 5, 9, 9, 9, 9}),
            (Row{1, 5, 5, 5, 9, 9, 9, 9}));
}

/// EQUATIONS §5.1 place by place, written from the contract with lists instead of running limits.
Row plain_snapped(const Edges& edges, int max_px, const Row& row) {
  const int width = static_cast<int>(row.size());
  const auto at = [&](int x) { return row[x]; };
  const auto edge = [&](int x) { return edges[x] != 0; };
  std::vector<int> before;
  for (int b = 0; b + 1 < width; ++b) {
    if (!std::isnan(at(b)) && !std::isnan(at(b + 1)) && std::abs(at(b + 1) - at(b)) > 1) {
      before.push_back(b);
    }
  }
  std::vector<int> after;
  Row result = row;
  for (std::size_t k = 0; k < before.size(); ++k) {
    const int b = before[k];
    int best = b;
    int best_move = max_px + 1;
    for (int p = 0; p + 1 < width; ++p) {
      bool allowed = edge(p) || edge(p + 1);
      for (std::size_t other = 0; other < before.size(); ++other) {
        if (other < k) {
          allowed = allowed && p > before[other] && p > after[other];
        } else if (other > k) {
          allowed = allowed && p < before[other];
        }
      }
      for (int x = std::min(p, b) + 1; x <= std::max(p, b); ++x) {
        allowed = allowed && !std::isnan(at(x));
      }
      if (allowed && std::abs(p - b) < best_move) {
        best = p;
        best_move = std::abs(p - b);
      }
    }
    after.push_back(best);
    for (int x = best + 1; x <= b; ++x) {
      result[x] = at(b + 1);
    }
    for (int x = b + 1; x <= best; ++x) {
      result[x] = at(b);
    }
  }
  return result;
}

TEST(EdgeSnapping, EqualsPlainTranscription) {
  std::mt19937 random(5);
  for (int width = 1; width <= 60; ++width) {
    for (const int max_px : {0, 1, 2, 4, 16}) {
      for (int trial = 0; trial < 6; ++trial) {
        Edges edges(static_cast<std::size_t>(width));
        Row row(edges.size());
        for (std::size_t x = 0; x < row.size(); ++x) {
          edges[x] = random() % 6 == 0 ? 255 : 0;
          const bool repeats = x > 0 && random() % 4 != 0;
          row[x] = repeats             ? row[x - 1] + 0.25F * static_cast<float>(random() % 3)
                   : random() % 5 == 0 ? kUnknown
                                       : static_cast<float>(random() % 12);
        }
        ASSERT_EQ(bits(snapped(edges, max_px, row)), bits(plain_snapped(edges, max_px, row)))
            << "width " << width << ", most " << max_px;
      }
    }
  }
}

}  // namespace vantage::kernels::edge_snapping_test
