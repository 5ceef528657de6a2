#include "engine/evaluation/cumulative_response.h"

#include "engine/generation/portable_random.h"
#include "tests/engine/engine_test.h"
#include "tests/engine/plain_costs.h"

namespace vantage::cumulative_response_test {

constexpr ImagePart kParts[] = {ImagePart::kWhole, ImagePart::kTopLeft, ImagePart::kTopRight,
                                ImagePart::kBottomLeft, ImagePart::kBottomRight};

/// A view of an endless smooth random texture, 8-bit grey, whose corner is at (x, y) of it.
Photograph texture_at(int x_begin, int y_begin, int width, int height) {
  constexpr int kPeriod = 97;
  PortableRandom random(7, 0);
  std::vector<double> values(kPeriod * kPeriod);
  for (double& value : values) {
    value = 255 * random.uniform();
  }
  const auto at = [&](int x, int y) {
    const auto wrap = [](int i) {
      return static_cast<std::size_t>((i % kPeriod + kPeriod) % kPeriod);
    };
    return values[wrap(y) * kPeriod + wrap(x)];
  };
  Image<std::uint8_t> image(width, height);
  for (const auto [x, y] : positions_of(width, height)) {
    const int u = x + x_begin;
    const int v = y + y_begin;
    image.at(x, y) = static_cast<std::uint8_t>((2 * at(u, v) + at(u + 1, v) + at(u, v + 1)) / 4);
  }
  return {std::move(image)};
}

struct PlainSums {
  double whole = 0;
  double quadrant[4] = {};
};

/// ΣE of one displacement, from the equations.
PlainSums plain_sums(const Photograph& left, const Photograph& right,
                     const MethodParameters& parameters, Displacement displacement) {
  const auto gradient = [&](const Photograph& image) {
    return gradient_of(planes_of(image, ColourUse::kLuma)[0], parameters.gradient,
                       parameters.prefilter);
  };
  const Gradient of_left = gradient(left);
  const Gradient of_right = gradient(right);
  PlainSums sums;
  for (int y = 0; y < left.height(); ++y) {
    for (int x = 0; x < left.width(); ++x) {
      const int partner_x = x - displacement.x_px;
      const int partner_y = y - displacement.y_px;
      if (partner_x < 0 || partner_x >= left.width() || partner_y < 0 ||
          partner_y >= left.height()) {
        continue;
      }
      const double lx = of_left.x.at(x, y);
      const double ly = of_left.y.at(x, y);
      const double rx = of_right.x.at(partner_x, partner_y);
      const double ry = of_right.y.at(partner_x, partner_y);
      const auto length = [&](double a, double b) { return length_of(a, b, parameters); };
      const double evidence =
          (length(lx, ly) + length(rx, ry)) / 2 - parameters.alpha * length(lx - rx, ly - ry);
      sums.whole += evidence;
      sums.quadrant[(y >= left.height() / 2 ? 2 : 0) + (x >= left.width() / 2 ? 1 : 0)] += evidence;
    }
  }
  return sums;
}

void expect_equals_equations(const Photograph& left, const Photograph& right,
                             const CumulativeResponseOptions& options) {
  const CumulativeResponse response = cumulative_response(left, right, options, execution());
  const double bound = 1e-3 * left.width() * left.height();
  for (int dy = options.displacements_y.min; dy <= options.displacements_y.max; ++dy) {
    for (int dx = options.displacements_x.min; dx <= options.displacements_x.max; ++dx) {
      const PlainSums expected = plain_sums(left, right, options.parameters, {dx, dy});
      EXPECT_NEAR(response.at(ImagePart::kWhole, {dx, dy}), expected.whole, bound);
      for (int quadrant = 0; quadrant < 4; ++quadrant) {
        EXPECT_NEAR(response.at(kParts[quadrant + 1], {dx, dy}), expected.quadrant[quadrant], bound)
            << dx << ' ' << dy << ' ' << quadrant;
      }
    }
  }
}

struct Size {
  int width;
  int height;
};

TEST(CumulativeResponse, EqualsTheEquationsForAwkwardSizes) {
  for (const auto& [width, height] : {Size{1, 1}, Size{1, 9}, Size{9, 1}, Size{2, 3}, Size{15, 17},
                                      Size{33, 16}, Size{37, 31}, Size{64, 5}, Size{300, 20}}) {
    CumulativeResponseOptions options;
    options.displacements_x = {-3, 4};
    options.displacements_y = {-2, 1};
    expect_equals_equations(noise<std::uint8_t>(width, height, 1, 1),
                            noise<std::uint8_t>(width, height, 1, 2), options);
  }
}

TEST(CumulativeResponse, EqualsTheEquationsForAllParameters) {
  const Photograph left = noise<float>(29, 13, 3, 1);
  const Photograph right = noise<float>(29, 13, 3, 2);
  for (const GradientFilter filter :
       {GradientFilter::kCentral, GradientFilter::kSobel, GradientFilter::kSimoncelli3,
        GradientFilter::kSimoncelli5, GradientFilter::kForward}) {
    for (const GradientNorm norm :
         {GradientNorm::kL2, GradientNorm::kOctagon, GradientNorm::kL1, GradientNorm::kMax}) {
      CumulativeResponseOptions options;
      options.displacements_x = {-1, 1};
      options.parameters.gradient = filter;
      options.parameters.norm = norm;
      options.parameters.gradient_components =
          norm == GradientNorm::kMax ? GradientComponents::kX : GradientComponents::kXy;
      options.parameters.prefilter = norm == GradientNorm::kL2;
      options.parameters.alpha = norm == GradientNorm::kL2 ? 0.8 : 1.3;
      expect_equals_equations(left, right, options);
    }
  }
}

TEST(CumulativeResponse, DisplacementsBeyondTheImageCountNothing) {
  CumulativeResponseOptions options;
  options.displacements_x = {-12, 12};
  options.displacements_y = {-9, 9};
  const Photograph left = noise<std::uint8_t>(10, 7, 1, 1);
  const CumulativeResponse response = cumulative_response(left, left, options, execution());
  for (const ImagePart part : kParts) {
    EXPECT_EQ(response.at(part, {10, 0}), 0);
    EXPECT_EQ(response.at(part, {-10, 0}), 0);
    EXPECT_EQ(response.at(part, {0, 7}), 0);
  }
  EXPECT_NE(response.at(ImagePart::kTopRight, {9, 0}), 0);
  EXPECT_EQ(response.dominant(ImagePart::kWhole), (Displacement{0, 0}));
}

TEST(CumulativeResponse, FindsKnownShiftsInEachDirection) {
  CumulativeResponseOptions options;
  options.displacements_x = {-12, 12};
  options.displacements_y = {-5, 5};
  for (const Displacement shift : {Displacement{0, 0}, {7, 0}, {-9, 0}, {3, 4}, {-5, -3}}) {
    const Photograph left = texture_at(0, 0, 90, 70);
    // Position in the left image minus position in the right one.
    const Photograph right = texture_at(shift.x_px, shift.y_px, 90, 70);
    const CumulativeResponse response = cumulative_response(left, right, options, execution());
    for (const ImagePart part : kParts) {
      EXPECT_EQ(response.dominant(part), shift) << shift.x_px << ' ' << shift.y_px;
    }
  }
}

TEST(CumulativeResponse, FindsTheShiftOfEachQuadrant) {
  const Photograph left = texture_at(0, 0, 100, 80);
  const int shifts[] = {2, 5, -4, 9};
  Image<std::uint8_t> right(100, 80);
  const Photograph shifted[] = {
      texture_at(shifts[0], 0, 100, 80), texture_at(shifts[1], 0, 100, 80),
      texture_at(shifts[2], 0, 100, 80), texture_at(shifts[3], 0, 100, 80)};
  for (const auto [x, y] : positions_of(100, 80)) {
    const int quadrant = (y >= 40 ? 2 : 0) + (x >= 50 ? 1 : 0);
    right.at(x, y) = std::get<Image<std::uint8_t>>(shifted[quadrant].pixels).at(x, y);
  }
  CumulativeResponseOptions options;
  options.displacements_x = {-16, 16};
  const CumulativeResponse response =
      cumulative_response(left, {std::move(right)}, options, execution());
  for (int quadrant = 0; quadrant < 4; ++quadrant) {
    EXPECT_EQ(response.dominant(kParts[quadrant + 1]), (Displacement{shifts[quadrant], 0}));
  }
}

TEST(CumulativeResponse, NothingDominatesForLackOfPartners) {
  // Unrelated images: each pixel with a partner is evidence against the displacement.
  const Photograph left = noise<std::uint8_t>(60, 40, 1, 1);
  const Photograph right = noise<std::uint8_t>(60, 40, 1, 2);
  CumulativeResponseOptions options;
  options.displacements_x = {-70, 70};
  const CumulativeResponse response = cumulative_response(left, right, options, execution());
  const auto whole = response.dominant(ImagePart::kWhole);
  ASSERT_TRUE(whole.has_value());
  EXPECT_LT(response.at(ImagePart::kWhole, *whole), 0);
  EXPECT_LE(std::abs(whole->x_px), 30);
  const auto left_half = response.dominant(ImagePart::kTopLeft);
  ASSERT_TRUE(left_half.has_value());
  EXPECT_TRUE(left_half->x_px <= 15 && left_half->x_px >= -45);
  options.displacements_x = {40, 50};
  EXPECT_EQ(cumulative_response(left, right, options, execution()).dominant(ImagePart::kWhole),
            std::nullopt);
}

TEST(CumulativeResponse, IsIdenticalForAnyThreads) {
  const Photograph left = noise<std::uint16_t>(277, 53, 3, 1);
  const Photograph right = noise<std::uint16_t>(277, 53, 3, 2);
  CumulativeResponseOptions options;
  options.displacements_x = {-40, 41};
  options.displacements_y = {-1, 1};
  Execution one({.threads = 1, .executor = scheduler::ExecutorKind::kSerial});
  const CumulativeResponse expected = cumulative_response(left, right, options, one);
  for (const int threads : {2, 3}) {
    Execution several({.threads = threads});
    EXPECT_EQ(cumulative_response(left, right, options, several).surfaces, expected.surfaces);
  }
  // Nor does a sum depend on which others are asked for.
  options.displacements_x = {7, 7};
  options.displacements_y = {1, 1};
  const CumulativeResponse single = cumulative_response(left, right, options, one);
  for (const ImagePart part : kParts) {
    EXPECT_EQ(single.at(part, {7, 1}), expected.at(part, {7, 1}));
  }
}

TEST(CumulativeResponse, ConstantImagesHaveNoDominantDisplacement) {
  Image<std::uint8_t> grey(20, 10);
  grey.fill(90);
  const Photograph image{std::move(grey)};
  CumulativeResponseOptions options;
  options.displacements_x = {-3, 3};
  const CumulativeResponse response = cumulative_response(image, image, options, execution());
  for (const ImagePart part : kParts) {
    EXPECT_EQ(response.dominant(part), std::nullopt);
  }
}

TEST(CumulativeResponse, RefusesBadOptionsAndUnequalSizes) {
  const Photograph image = noise<std::uint8_t>(20, 10, 1);
  const auto error_of = [&](const CumulativeResponseOptions& options) {
    return test::error_of([&] { cumulative_response(image, image, options, execution()); });
  };
  CumulativeResponseOptions options;
  options.displacements_x = {5, 4};
  EXPECT_THAT(error_of(options), HasSubstr("displacements-x is 5:4"));
  options.displacements_x = {-30000, 30000};
  options.displacements_y = {-30000, 30000};
  EXPECT_THAT(error_of(options), HasSubstr("expected at most 1048576"));
  options.displacements_x = {0, 70000};
  EXPECT_THAT(error_of(options), HasSubstr("expected numbers within"));
  options.displacements_x = options.displacements_y = {0, 1};
  options.parameters.alpha = -1;
  EXPECT_THAT(error_of(options), HasSubstr("alpha is -1"));
  options.parameters.alpha = 1;
  EXPECT_THAT(test::error_of([&] {
                cumulative_response(image, noise<std::uint8_t>(21, 10, 1), options, execution());
              }),
              HasSubstr("20x10 but right image is 21x10"));
}

}  // namespace vantage::cumulative_response_test
