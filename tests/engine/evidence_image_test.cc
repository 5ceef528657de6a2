#include "engine/evaluation/evidence_image.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/error.h"
#include "engine/evaluation/rms_differences.h"
#include "tests/engine/plain_costs.h"
#include "tests/engine/random_grey.h"

namespace vantage {
namespace evidence_image_test {

MethodParameters plain_gradient() {
  MethodParameters parameters = book_parameters(MatchMethod::kGradient);
  parameters.prefilter = false;
  parameters.alpha = 0.8;
  return parameters;
}

TEST(EvidenceImage, IsTheBooksMeasure) {
  const Photograph left = test::random_grey(23, 11, 256, 1);
  const Photograph right = test::random_grey(23, 11, 256, 2);
  const auto gradient = [](const Photograph& image) {
    return test::gradient_of(test::planes_of(image, ColourUse::kLuma)[0], GradientFilter::kCentral,
                             false);
  };
  const test::Gradient of_left = gradient(left);
  const test::Gradient of_right = gradient(right);
  Execution execution({.threads = 2});
  for (const Displacement displacement : {Displacement{0, 0}, {3, -2}, {-4, 1}, {30, 0}}) {
    const Image<float> evidence =
        evidence_image(left, right, displacement, plain_gradient(), execution);
    for (int y = 0; y < 11; ++y) {
      for (int x = 0; x < 23; ++x) {
        const int partner_x = x - displacement.x_px;
        const int partner_y = y - displacement.y_px;
        if (partner_x < 0 || partner_x >= 23 || partner_y < 0 || partner_y >= 11) {
          EXPECT_TRUE(std::isnan(evidence.at(x, y)));
          continue;
        }
        const double lx = of_left.x.at(x, y);
        const double ly = of_left.y.at(x, y);
        const double rx = of_right.x.at(partner_x, partner_y);
        const double ry = of_right.y.at(partner_x, partner_y);
        const double expected =
            (std::hypot(lx, ly) + std::hypot(rx, ry)) / 2 - 0.8 * std::hypot(lx - rx, ly - ry);
        ASSERT_NEAR(static_cast<double>(evidence.at(x, y)), expected, 1e-3) << x << ' ' << y;
      }
    }
  }
}

TEST(RmsDifferences, AreThoseOfTheOverlap) {
  const Photograph left = test::random_grey(13, 7, 256, 3);
  const Photograph right = test::random_grey(13, 7, 256, 4);
  const auto& left_pixels = std::get<Image<std::uint8_t>>(left.pixels);
  const auto& right_pixels = std::get<Image<std::uint8_t>>(right.pixels);
  Execution execution({.threads = 3});
  const DisparityRange range_x{-14, 5};
  const DisparityRange range_y{-2, 8};
  const std::vector<double> rms = rms_differences(left, right, range_x, range_y, execution);
  ASSERT_EQ(rms.size(), 20U * 11);
  std::size_t index = 0;
  for (int dy = range_y.min; dy <= range_y.max; ++dy) {
    for (int dx = range_x.min; dx <= range_x.max; ++dx, ++index) {
      double sum = 0;
      int count = 0;
      for (int y = 0; y < 7; ++y) {
        for (int x = 0; x < 13; ++x) {
          if (x - dx >= 0 && x - dx < 13 && y - dy >= 0 && y - dy < 7) {
            sum += std::pow(left_pixels.at(x, y) - right_pixels.at(x - dx, y - dy), 2);
            ++count;
          }
        }
      }
      if (count == 0) {
        EXPECT_TRUE(std::isnan(rms[index]));
      } else {
        EXPECT_NEAR(rms[index], std::sqrt(sum / count), 1e-9) << dx << ' ' << dy;
      }
    }
  }
  EXPECT_THROW(rms_differences(left, test::random_grey(12, 7, 256, 4), {0, 1}, {0, 0}, execution),
               Error);
}

}  // namespace evidence_image_test
}  // namespace vantage
