#include "kernels/forward_warp/forward_warp.h"

#include "tests/kernels/synthesis_rows.h"

namespace vantage::kernels::forward_warp_test {

constexpr double kOffsets[] = {-2.5, -1.0, -0.75, -0.5, -0.3, 0.0, 0.1, 0.25, 0.5, 1.0, 1.75, 4.0};

struct Warped {
  std::vector<float> disparity_px;
  std::vector<float> source_column;
};

Warped warp(const std::vector<float>& disparity_px, double offset, float limit) {
  const std::size_t width = disparity_px.size();
  Warped result{std::vector<float>(width), std::vector<float>(width)};
  forward_warp_row({disparity_px.data(), static_cast<int>(width), offset, limit},
                   result.disparity_px.data(), result.source_column.data());
  return result;
}

// A z-buffer over single samples in no meaningful order: the nearest sample at each position. Ties
// are counted: the ordered walk promises there are none.
class ZBuffer {
 public:
  explicit ZBuffer(int width)
      : disparity_(static_cast<std::size_t>(width), -std::numeric_limits<double>::infinity()),
        column_(static_cast<std::size_t>(width), kUnknownDisparity) {}

  void add(long target, double disparity, double column) {
    if (target < 0 || target >= static_cast<long>(disparity_.size())) {
      return;
    }
    const auto n = static_cast<std::size_t>(target);
    ties += disparity == disparity_[n] ? 1 : 0;
    if (disparity > disparity_[n]) {
      disparity_[n] = disparity;
      column_[n] = column;
    }
  }

  void expect_equal(const Warped& warped, float tolerance) const {
    for (std::size_t n = 0; n < disparity_.size(); ++n) {
      if (std::isinf(disparity_[n])) {
        ASSERT_TRUE(std::isnan(warped.disparity_px[n])) << "position " << n;
        ASSERT_TRUE(std::isnan(warped.source_column[n])) << "position " << n;
      } else {
        ASSERT_NEAR(warped.disparity_px[n], disparity_[n], tolerance) << "position " << n;
        ASSERT_NEAR(warped.source_column[n], column_[n], tolerance) << "position " << n;
      }
    }
  }

  int ties = 0;

 private:
  std::vector<double> disparity_;
  std::vector<double> column_;
};

void add_pixels(const std::vector<float>& d, double s, ZBuffer& buffer) {
  for (std::size_t x = 0; x < d.size(); ++x) {
    if (std::isfinite(d[x])) {
      const double column = static_cast<double>(x);
      buffer.add(std::lround(std::floor(column - s * d[x] + 0.5)), d[x], column);
    }
  }
}

// Every position strictly between two neighbours' real targets, unless rounding gives it to one of
// them.
void add_sampling_gaps(const std::vector<float>& d, double s, float limit, ZBuffer& buffer) {
  for (std::size_t x = 0; x + 1 < d.size(); ++x) {
    if (!(std::abs(d[x + 1] - d[x]) <= limit)) {
      continue;
    }
    const double from = static_cast<double>(x) - s * d[x];
    const double to = static_cast<double>(x) + 1 - s * d[x + 1];
    for (double n = std::floor(from + 0.5) + 1; n < std::floor(to + 0.5); ++n) {
      const double f = (n - from) / (to - from);
      buffer.add(std::lround(n), (1 - f) * d[x] + f * d[x + 1], static_cast<double>(x) + f);
    }
  }
}

TEST(ForwardWarp, OrderedWalkEqualsZBufferOnRandomMaps) {
  std::mt19937 random(1);
  for (const int width : kAwkwardWidths) {
    for (const double s : kOffsets) {
      for (int repeat = 0; repeat < 4; ++repeat) {
        // White noise in quarter pixels: as many collisions as can be. Without a limit no gaps.
        std::vector<float> d(width);
        for (float& value : d) {
          const auto draw = random() % 161;
          value = draw == 0 ? kUnknownDisparity : static_cast<float>(draw) / 4 - 10;
        }
        ZBuffer buffer(width);
        add_pixels(d, s, buffer);
        EXPECT_EQ(buffer.ties, 0);
        buffer.expect_equal(warp(d, s, 0), 0);
        ASSERT_FALSE(HasFatalFailure()) << "width " << width << ", s " << s;
      }
    }
  }
}

TEST(ForwardWarp, SamplingGapsEqualZBufferOverAllSamples) {
  std::mt19937 random(2);
  for (const int width : kAwkwardWidths) {
    for (const double s : kOffsets) {
      for (const float limit : {0.5F, 1.0F, 3.0F}) {
        const std::vector<float> d = random_disparities(random, width, -6, 30);
        ZBuffer buffer(width);
        add_pixels(d, s, buffer);
        add_sampling_gaps(d, s, limit, buffer);
        buffer.expect_equal(warp(d, s, limit), 3e-5F);
        ASSERT_FALSE(HasFatalFailure()) << "width " << width << ", s " << s << ", limit " << limit;
      }
    }
  }
}

TEST(ForwardWarp, EqualOnEveryInstructionSet) {
  std::mt19937 random(3);
  for (const int width : kAwkwardWidths) {
    for (const double s : kOffsets) {
      std::vector<float> d = random_disparities(random, width, -20, 60);
      d[random() % d.size()] = std::numeric_limits<float>::infinity();
      const std::size_t size = d.size();
      const Warped expected = warp(d, s, 1.0F);
      const ForwardWarpRow row{d.data(), width, s, 1.0F};
      for_each_target([&] {
        const Warped result = warp(d, s, 1.0F);
        std::vector<float> alone(size);
        forward_warp_row(row, alone.data(), nullptr);
        ASSERT_TRUE(are_same(result.disparity_px, expected.disparity_px));
        ASSERT_TRUE(are_same(result.source_column, expected.source_column));
        ASSERT_TRUE(are_same(alone, expected.disparity_px));
      });
    }
  }
}

TEST(ForwardWarp, ForegroundCoversBackgroundSeenThroughItsGaps) {
  // A slanted foreground stretched to every other position, over a background between them.
  const std::vector<float> d = {0, 0, 0, 0, 0, 0, 0, 0, 12, 11, 10, 9};
  const Warped warped = warp(d, 1.0, 1.0F);
  EXPECT_EQ(warped.disparity_px[0], 10.0F);  // pixel 10
  EXPECT_EQ(warped.disparity_px[1], 9.5F);   // between 10 and 11
  EXPECT_EQ(warped.source_column[1], 10.5F);
  EXPECT_EQ(warped.disparity_px[2], 9.0F);
  EXPECT_EQ(warped.disparity_px[3], 0.0F);
  EXPECT_TRUE(std::isnan(warped.disparity_px[8]));  // uncovered background: a hole
}

TEST(ForwardWarp, NothingToWarp) {
  for (const double s : {-16.0, 0.0, 16.0}) {
    for (const float d : {kUnknownDisparity, std::numeric_limits<float>::infinity(),
                          -std::numeric_limits<float>::infinity()}) {
      const Warped warped = warp(std::vector<float>(5, d), s, 1.0F);
      for (const float value : warped.disparity_px) {
        EXPECT_TRUE(std::isnan(value));
      }
    }
  }
  for (const float d : {3e38F, -3e38F, 1e10F, -1e10F}) {
    EXPECT_TRUE(std::isnan(warp({d, d, d}, 16.0, 1e30F).disparity_px[1])) << d;
    EXPECT_EQ(warp({d, d, d}, 0.0, 1.0F).disparity_px[1], d);
  }
  // Neighbours that land on either side of the view, far outside, leave a gap all through it.
  const Warped wide = warp({1e9F, -1e9F}, 1.0, 3e9F);
  EXPECT_NEAR(wide.disparity_px[0], 0.0F, 100.0F);
}

}  // namespace vantage::kernels::forward_warp_test
