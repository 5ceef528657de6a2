#include "engine/io/images/png_encoder.h"

#include "tests/engine/engine_test.h"

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace vantage::png_encoder_test {

using Bytes = std::vector<std::uint8_t>;

constexpr std::array<std::array<int, 2>, 6> kSizes = {
    {{1, 1}, {1, 7}, {13, 1}, {67, 19}, {257, 300}, {1400, 96}}};

/// The image that OpenCV's decoder, libpng's, reads from a file.
template <typename T>
Image<T> read_by_opencv(const Bytes& bytes) {
  const cv::Mat read = cv::imdecode(bytes, cv::IMREAD_UNCHANGED);
  cv::Mat pixels = read;
  if (read.channels() != 1) {
    cv::cvtColor(read, pixels, read.channels() == 3 ? cv::COLOR_BGR2RGB : cv::COLOR_BGRA2RGBA);
  }
  Image<T> image(pixels.cols, pixels.rows, pixels.channels());
  for (int y = 0; y < pixels.rows; ++y) {
    std::copy_n(pixels.ptr<T>(y), pixels.cols * pixels.channels(), image.row(y));
  }
  return image;
}

/// Noise with flat parts.
template <typename T>
Image<T> picture(int width, int height, int channels) {
  Photograph photograph = noise<T>(width, height, channels);
  auto& image = std::get<Image<T>>(photograph.pixels);
  for (const auto [x, y] : positions_of({width / 3, width}, {0, height})) {
    for (int c = 0; c < channels && (x * 7 + y * 3) % 11 != 0; ++c) {
      image.at(x, y, c) = static_cast<T>(y % 5 == 0 ? 200 : x + 3 * y + c);
    }
  }
  return std::move(image);
}

template <typename T>
void write_and_read() {
  for (const auto& [width, height] : kSizes) {
    for (const int channels : {1, 3, 4}) {
      SCOPED_TRACE(testing::Message() << width << "x" << height << "x" << channels);
      const Image<T> image = picture<T>(width, height, channels);
      Bytes bytes = {1, 2, 3};  // of another file
      encode_png(image, bytes);
      const Image<T> read = read_by_opencv<T>(bytes);
      ASSERT_EQ(read.width(), width);
      ASSERT_EQ(read.height(), height);
      ASSERT_EQ(read.channels(), channels);
      for (int y = 0; y < height; ++y) {
        ASSERT_TRUE(std::equal(image.row(y), image.row(y) + width * channels, read.row(y)));
      }
      // Photographs of noise grow by little, flat ones shrink.
      ASSERT_LT(bytes.size(), image.view().stride() * static_cast<std::size_t>(height) * sizeof(T) +
                                  static_cast<std::size_t>(height) + 100);
    }
  }
}

TEST(PngEncoder, OpenCvReadsBytes) { write_and_read<std::uint8_t>(); }
TEST(PngEncoder, OpenCvReadsWords) { write_and_read<std::uint16_t>(); }

TEST(PngEncoder, NothingOfAnImageWiderThanLibpngWrites) {
  Bytes bytes = {1, 2, 3};
  encode_png(Image<std::uint8_t>(1000001, 1, 1), bytes);
  EXPECT_TRUE(bytes.empty());
}

}  // namespace vantage::png_encoder_test
