#include "engine/image/resized.h"

#include <opencv2/imgproc.hpp>

#include "tests/engine/engine_test.h"

namespace vantage::resized_test {

template <typename T>
Image<T> random_image(int width, int height, int channels) {
  std::mt19937 random(static_cast<unsigned>(width * 7 + height));
  Image<T> image(width, height, channels);
  for (int y = 0; y < height; ++y) {
    std::generate_n(image.row(y), width * channels, [&] {
      if constexpr (std::is_floating_point_v<T>) {
        return static_cast<float>(random()) / 16777216.0F;
      } else {
        return static_cast<T>(random() >> 11U);
      }
    });
  }
  return image;
}

template <typename T>
void expect_as_opencv(Image<T> image, const Image<T>& result, int interpolation) {
  const cv::Mat given(image.height(), image.width(),
                      CV_MAKETYPE(cv::DataType<T>::depth, image.channels()), image.row(0),
                      image.view().stride() * sizeof(T));
  cv::Mat expected;
  cv::resize(given, expected, {result.width(), result.height()}, 0, 0, interpolation);
  for (int y = 0; y < result.height(); ++y) {
    ASSERT_EQ(std::memcmp(result.row(y), expected.ptr(y),
                          sizeof(T) * static_cast<std::size_t>(result.width() * result.channels())),
              0)
        << image.width() << "x" << image.height() << "x" << image.channels() << " -> "
        << result.width() << "x" << result.height() << ", row " << y;
  }
}

template <typename T>
void expect_areas() {
  for (const auto& [width, height, new_width, new_height] : {std::array{61, 37, 43, 26},
                                                             {64, 36, 32, 18},
                                                             {60, 36, 20, 9},
                                                             {61, 37, 61, 12},
                                                             {33, 9, 1, 1},
                                                             {35, 21, 34, 20}}) {
    for (const int channels : {1, 3, 4}) {
      Image<T> image = random_image<T>(width, height, channels);
      const Image<T> result =
          reduced_by_area<T>(std::as_const(image).view(), new_width, new_height);
      expect_as_opencv(std::move(image), result, cv::INTER_AREA);
    }
  }
}

// Where OpenCV's own code rounds a product and a sum at once, its bits are others.
#ifdef __aarch64__
constexpr bool kOpenCvFuses = true;
#else
constexpr bool kOpenCvFuses = false;
#endif

TEST(Resized, AreasAreThoseOfOpenCv) {
  if (kOpenCvFuses) {
    GTEST_SKIP() << "OpenCV rounds otherwise on this processor";
  }
  expect_areas<std::uint8_t>();
  expect_areas<std::uint16_t>();
  expect_areas<float>();
}

TEST(Resized, NearestAndLinearAreThoseOfOpenCv) {
  if (kOpenCvFuses) {
    GTEST_SKIP() << "OpenCV rounds otherwise on this processor";
  }
  for (const auto& [width, height, new_width, new_height] : {std::array{31, 19, 62, 38},
                                                             {31, 19, 77, 50},
                                                             {1, 7, 3, 9},
                                                             {40, 20, 23, 20},
                                                             {17, 13, 17, 13}}) {
    Image<float> image = random_image<float>(width, height, 1);
    const Image<float> nearest =
        resized_to_nearest<float>(std::as_const(image).view(), new_width, new_height);
    const Image<float> linear =
        resized_linearly(std::as_const(image).view(), new_width, new_height);
    expect_as_opencv(image.copy(), nearest, cv::INTER_NEAREST);
    expect_as_opencv(std::move(image), linear, cv::INTER_LINEAR);
  }
}

}  // namespace vantage::resized_test
