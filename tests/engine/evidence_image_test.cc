#include "engine/evaluation/evidence_image.h"

#include "engine/evaluation/rms_differences.h"
#include "tests/engine/engine_test.h"
#include "tests/engine/plain_costs.h"
#include "tests/engine/random_grey.h"

namespace vantage::evidence_image_test {

MethodParameters plain_gradient() {
  MethodParameters parameters = book_parameters(MatchMethod::kGradient);
  parameters.prefilter = false;
  parameters.alpha = 0.8;
  return parameters;
}

TEST(EvidenceImage, IsTheBooksMeasure) {
  const Photograph left = random_grey(23, 11, 256, 1);
  const Photograph right = random_grey(23, 11, 256, 2);
  const auto gradient = [](const Photograph& image) {
    return gradient_of(planes_of(image, ColourUse::kLuma)[0], GradientFilter::kCentral, false);
  };
  const Gradient of_left = gradient(left);
  const Gradient of_right = gradient(right);
  for (const Displacement displacement : {Displacement{0, 0}, {3, -2}, {-4, 1}, {30, 0}}) {
    const Image<float> evidence =
        evidence_image(left, right, displacement, plain_gradient(), execution());
    for (const auto [x, y] : positions_of(23, 11)) {
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

TEST(RmsDifferences, AreThoseOfTheOverlap) {
  const Photograph left = random_grey(13, 7, 256, 3);
  const Photograph right = random_grey(13, 7, 256, 4);
  const auto& left_pixels = std::get<Image<std::uint8_t>>(left.pixels);
  const auto& right_pixels = std::get<Image<std::uint8_t>>(right.pixels);
  const DisparityRange range_x{-14, 5};
  const DisparityRange range_y{-2, 8};
  const std::vector<double> rms = rms_differences(left, right, range_x, range_y, execution());
  ASSERT_EQ(rms.size(), 20U * 11);
  std::size_t index = 0;
  for (int dy = range_y.min; dy <= range_y.max; ++dy) {
    for (int dx = range_x.min; dx <= range_x.max; ++dx, ++index) {
      double sum = 0;
      int count = 0;
      for (const auto [x, y] : positions_of(13, 7)) {
        if (x - dx >= 0 && x - dx < 13 && y - dy >= 0 && y - dy < 7) {
          sum += std::pow(left_pixels.at(x, y) - right_pixels.at(x - dx, y - dy), 2);
          ++count;
        }
      }
      if (count == 0) {
        EXPECT_TRUE(std::isnan(rms[index]));
      } else {
        EXPECT_NEAR(rms[index], std::sqrt(sum / count), 1e-9) << dx << ' ' << dy;
      }
    }
  }
  EXPECT_THROW(rms_differences(left, random_grey(12, 7, 256, 4), {0, 1}, {0, 0}, execution()),
               Error);
}

}  // namespace vantage::evidence_image_test
