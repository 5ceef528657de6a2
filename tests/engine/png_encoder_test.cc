#include "engine/io/png_encoder.h"

#include <gtest/gtest.h>

#include <array>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <utility>
#include <vector>

#include "tests/engine/io_test_support.h"

namespace vantage {
namespace png_encoder_test {

using Bytes = std::vector<std::uint8_t>;
using test::noise;

constexpr std::array<std::array<int, 2>, 6> kSizes = {
    {{1, 1}, {1, 7}, {13, 1}, {67, 19}, {257, 300}, {1400, 96}}};

/// The file that OpenCV makes of an image.
template <typename T>
Bytes by_opencv(const Image<T>& image) {
  cv::Mat pixels(image.height(), image.width(),
                 CV_MAKETYPE(cv::DataType<T>::depth, image.channels()),
                 const_cast<T*>(image.row(0)), image.view().stride() * sizeof(T));
  cv::Mat reordered = pixels;
  if (image.channels() != 1) {
    cv::cvtColor(pixels, reordered,
                 image.channels() == 3 ? cv::COLOR_RGB2BGR : cv::COLOR_RGBA2BGRA);
  }
  Bytes bytes;
  cv::imencode(".png", reordered, bytes);
  return bytes;
}

/// Noise with flat parts.
template <typename T>
Image<T> picture(int width, int height, int channels) {
  Photograph photograph = noise<T>(width, height, channels);
  auto& image = std::get<Image<T>>(photograph.pixels);
  for (int y = 0; y < height; ++y) {
    for (int x = width / 3; x < width; ++x) {
      for (int c = 0; c < channels && (x * 7 + y * 3) % 11 != 0; ++c) {
        image.at(x, y, c) = static_cast<T>(y % 5 == 0 ? 200 : x + 3 * y + c);
      }
    }
  }
  return std::move(image);
}

template <typename T>
void compare_with_opencv() {
  for (const auto& [width, height] : kSizes) {
    for (const int channels : {1, 3, 4}) {
      SCOPED_TRACE(testing::Message() << width << "x" << height << "x" << channels);
      const Image<T> image = picture<T>(width, height, channels);
      Bytes own = {1, 2, 3};  // of another file
      encode_png(image, own);
      ASSERT_EQ(own, by_opencv(image));
    }
  }
}

TEST(PngEncoder, BytesMakeTheFileThatOpenCvMakes) { compare_with_opencv<std::uint8_t>(); }
TEST(PngEncoder, WordsMakeTheFileThatOpenCvMakes) { compare_with_opencv<std::uint16_t>(); }

TEST(PngEncoder, NothingOfAnImageWiderThanLibpngWrites) {
  Bytes bytes = {1, 2, 3};
  encode_png(Image<std::uint8_t>(1000001, 1, 1), bytes);
  EXPECT_TRUE(bytes.empty());
}

}  // namespace png_encoder_test
}  // namespace vantage
