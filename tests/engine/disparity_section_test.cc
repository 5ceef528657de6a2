#include "engine/evaluation/disparity_section.h"

#include "tests/engine/engine_test.h"

namespace vantage::disparity_section_test {

TEST(DisparitySection, PictureIsDarkWhereLikelyAndUpward) {
  DisparitySection section;
  section.values = Image<float>(2, 2);
  section.values.at(0, 0) = 0;
  section.values.at(1, 0) = 5;
  section.values.at(0, 1) = 20;
  section.values.at(1, 1) = std::nanf("");
  const Image<std::uint8_t> picture = section_picture(section, 0, 10);
  EXPECT_EQ(picture.at(0, 1), 0);
  EXPECT_EQ(picture.at(1, 1), 128);
  EXPECT_EQ(picture.at(0, 0), 255);
  EXPECT_EQ(picture.at(1, 0), 255);
  EXPECT_FLOAT_EQ(section_quantile(section, 0.5), 5);
  EXPECT_FLOAT_EQ(section_quantile(section, 1), 20);
}

}  // namespace vantage::disparity_section_test
