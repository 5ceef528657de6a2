#include "kernels/surface_coverage/surface_coverage.h"

#include <utility>

#include "tests/kernels/projection_cases.h"

namespace vantage::kernels::surface_coverage_test {

/// A map and the way back into it.
struct Source {
  std::vector<float> d;
  CoverageSource source;

  Source(std::vector<float> map, int width, int height, const SourceProjection& way_back)
      : d(std::move(map)) {
    source = {.way_back = way_back,
              .disparity_px = d.data(),
              .stride = width,
              .width = width,
              .height = height,
              .gradient_limit_px = 1};
  }
};

// Views that move by whole and fractional pixels: position − s · d.
SourceProjection moved(double x, double y) {
  SourceProjection back;
  back.parallax[0] = -x;
  back.parallax[1] = -y;
  return back;
}

/// By integration: bilinear weights are the mean over one uniform displacement of what the nearest
/// pixel shows, the quadratic B-spline over two.
double integrated(const Source& source, double u, double v, double q, bool spline) {
  constexpr int kSteps = 24;
  const ExactSource at = exact_source(source.source.way_back, u, v, q);
  const auto member = [&](double x, double y) {
    const int column =
        std::clamp(static_cast<int>(std::floor(x + 0.5)), 0, source.source.width - 1);
    const int line = std::clamp(static_cast<int>(std::floor(y + 0.5)), 0, source.source.height - 1);
    const double d = source.d[line * source.source.width + column];
    return std::abs(d - at.disparity_px) <= 1 ? 1.0 : 0.0;
  };
  // Weights of displacements: of one uniform variable, or of the sum of two.
  const auto weight = [&](int k) {
    const int n = 2 * kSteps - 1;
    if (!spline) {
      return k < kSteps ? 1.0 / kSteps : 0.0;
    }
    return (kSteps - std::abs(k - (n - 1) / 2.0)) / (1.0 * kSteps * kSteps);
  };
  const auto offset = [&](int k) {
    return spline ? (k - (kSteps - 1.0)) / kSteps : (k - (kSteps - 1) / 2.0) / kSteps;
  };
  double sum = 0;
  for (int j = 0; j < 2 * kSteps - 1; ++j) {
    for (int i = 0; i < 2 * kSteps - 1; ++i) {
      const double w = weight(i) * weight(j);
      sum += w > 0 ? w * member(at.x + offset(i), at.y + offset(j)) : 0;
    }
  }
  return sum;
}

TEST(SurfaceCoverage, IsTheMeanOfWhatSurrounds) {
  std::mt19937 random(1);
  for (const auto& [width, height] : {std::pair{1, 1}, {1, 5}, {7, 1}, {5, 4}}) {
    for (int repeat = 0; repeat < 40; ++repeat) {
      std::vector<float> map;
      for (int k = 0; k < width * height; ++k) {
        const auto event = random() % 4;
        map.push_back(event == 0   ? 2.0F
                      : event == 1 ? std::numeric_limits<float>::quiet_NaN()
                                   : 9.5F);
      }
      const Source source(map, width, height, moved(0.5, -0.25));
      const double u = static_cast<double>(random() % 80) / 10 - 5;
      const double v = static_cast<double>(random() % 80) / 10 - 2;
      // 10 is 8 farther than 2: 4 and 2 pixels apart, nothing of the photograph's transition left.
      EXPECT_NEAR(surface_coverage(source.source, u, v, 10, 2), integrated(source, u, v, 10, true),
                  0.03);
      EXPECT_NEAR(surface_coverage(source.source, u, v, 10, 10),
                  integrated(source, u, v, 10, false), 0.05);
    }
  }
}

// What lies half-way between the two.
TEST(SurfaceCoverage, ChangesToTheSplineWithTheShift) {
  // A surface of disparity 8 that ends behind column 2.
  const Source source({8, 8, 8, 2, 2, 2, 2}, 7, 1, moved(0.5, 0));
  const double at_outline = 2.5 - 4;
  EXPECT_NEAR(surface_coverage(source.source, at_outline, 0, 8, 2), 0.5, 1e-12);
  EXPECT_NEAR(surface_coverage(source.source, at_outline, 0, 8, 8), 0.5, 1e-12);
  const double last = 2 - 4;
  EXPECT_NEAR(surface_coverage(source.source, last, 0, 8, 8), 1, 1e-12);
  EXPECT_NEAR(surface_coverage(source.source, last, 0, 8, 6), 1 - 0.125 / 2, 1e-12);
  EXPECT_NEAR(surface_coverage(source.source, last, 0, 8, 4), 1 - 0.125, 1e-12);
  EXPECT_NEAR(surface_coverage(source.source, last, 0, 8, 1), 1 - 0.125, 1e-12);
  EXPECT_NEAR(surface_coverage(source.source, last + 1, 0, 8, 8), 0, 1e-12);
  EXPECT_NEAR(surface_coverage(source.source, last + 1, 0, 8, 1), 0.125, 1e-12);
}

// All pixels of a line across an outline together are covered by as much as lies on its side,
// wherever in the pixel the outline comes to lie.
TEST(SurfaceCoverage, MovesWithTheView) {
  std::vector<float> map(40, 2);
  std::fill_n(map.begin(), 15, 9.0F);
  for (int step = 0; step <= 50; ++step) {
    const double view = 0.3 + 0.01 * step;
    const Source source(map, 40, 1, moved(view, 0));
    double covered = 0;
    for (int u = -5; u < 25; ++u) {
      covered += surface_coverage(source.source, u, 0, 9, 2);
    }
    // The outline, at 14½, moves left by 9 · view; pixels begin at −5½.
    EXPECT_NEAR(covered, 14.5 - 9 * view + 5.5, 1e-9) << view;
  }
}

// A straight outline at any angle covers what a half-plane does, to a fraction of what an outline
// of whole pixels would be off by.
TEST(SurfaceCoverage, StraightOutlinesAreStraight) {
  constexpr int kSize = 41;
  for (const double angle : {0.0, 0.2, 0.5, 0.785398163397448, 1.1, 2.4}) {
    const double nx = std::cos(angle);
    const double ny = std::sin(angle);
    std::vector<float> map;
    for (int y = 0; y < kSize; ++y) {
      for (int x = 0; x < kSize; ++x) {
        map.push_back(nx * (x - 20.2) + ny * (y - 20.1) < 0 ? 9.0F : 2.0F);
      }
    }
    const Source source(map, kSize, kSize, moved(0.7, -0.4));
    double squares = 0;
    double squares_of_whole_pixels = 0;
    for (int v = 18; v < 30; ++v) {
      for (int u = 8; u < 20; ++u) {
        const ExactSource at = exact_source(source.source.way_back, u, v, 9);
        const double distance = nx * (at.x - 20.2) + ny * (at.y - 20.1);
        const double covered = std::clamp(0.5 - distance, 0.0, 1.0);
        const double error = surface_coverage(source.source, u, v, 9, 2) - covered;
        const auto column = static_cast<std::size_t>(std::floor(at.x + 0.5));
        const auto line = static_cast<std::size_t>(std::floor(at.y + 0.5));
        const double whole = map[line * kSize + column] == 9.0F ? 1.0 : 0.0;
        squares += error * error;
        squares_of_whole_pixels += (whole - covered) * (whole - covered);
      }
    }
    EXPECT_LT(squares, 0.5 * squares_of_whole_pixels) << angle;
  }
}

TEST(SurfaceCoverage, IsKnownWhereverTheImageCanSee) {
  std::mt19937 random(2);
  for (const ViewProjection& view : projection_cases()) {
    SourceProjection back;
    back.is_translation = view.is_translation;
    std::copy_n(view.parallax, 3, back.parallax);
    if (!view.is_translation) {
      std::copy_n(view.homography, 9, back.homography);
    }
    const Source source(random_map(random, 13, 7), 13, 7, back);
    for (int repeat = 0; repeat < 300; ++repeat) {
      const double u = static_cast<double>(random() % 4000) - 2000;
      const double v = static_cast<double>(random() % 4000) - 2000;
      const double q = repeat % 10 == 0 ? 1e38 : static_cast<double>(random() % 200) / 7 - 9;
      const double covered = surface_coverage(source.source, u, v, q, q - 5);
      if (exact_source(back, u, v, q).is_visible) {
        ASSERT_GE(covered, 0);
        ASSERT_LE(covered, 1);
      } else {
        ASSERT_TRUE(std::isnan(covered));
      }
    }
  }
}

TEST(JointCoverage, MultipliesOddsOfEqualObservers) {
  const double unknown = std::nan("");
  EXPECT_EQ(joint_coverage(0.3, 0.7, unknown), 0.7);
  EXPECT_EQ(joint_coverage(0.3, unknown, 0.2), 0.2);
  EXPECT_TRUE(std::isnan(joint_coverage(0.3, unknown, unknown)));
  EXPECT_NEAR(joint_coverage(0.5, 0.5, 0.8), 0.8, 1e-12);
  EXPECT_NEAR(joint_coverage(0.5, 0.75, 0.75), 0.9, 1e-12);  // odds 3 · 3
  EXPECT_NEAR(joint_coverage(0.5, 0.25, 0.5), 0.25, 1e-12);
  EXPECT_NEAR(joint_coverage(0.5, 0, 1), 0.5, 1e-12);
  EXPECT_NEAR(joint_coverage(1, 0.3, 0.9), 0.3, 1e-12);
  EXPECT_NEAR(joint_coverage(0, 0.3, 0.9), 0.9, 1e-12);
  // Three quarters of the way from the mean 0.3 · ¼ + 0.9 · ¾ to odds 3/7 · 9.
  const double odds = 0.3 / 0.7 * 9;
  EXPECT_NEAR(joint_coverage(0.25, 0.3, 0.9), 0.75 + 0.75 * (odds / (1 + odds) - 0.75), 1e-12);
  EXPECT_GT(joint_coverage(0.5, 1, 1), 0.99);
  EXPECT_LE(joint_coverage(0.5, 1, 1), 1);
}

}  // namespace vantage::kernels::surface_coverage_test
