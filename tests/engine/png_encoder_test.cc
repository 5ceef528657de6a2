#include "engine/io/images/png_encoder.h"

#include "tests/engine/engine_test.h"

#include <libdeflate.h>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "engine/execution.h"
#include "engine/io/images/png_decoder.h"

namespace vantage::png_encoder_test {

using Bytes = std::vector<std::uint8_t>;

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

/// All checksums of the file are right, of which libpng forgives some.
void expect_checksums(const Bytes& bytes, std::size_t row_bytes, int height) {
  const PngStructure structure = check_png_structure(FileBytes(bytes, "a.png"));
  Bytes stream;
  for (const auto part : structure.pixel_data) {
    stream.insert(stream.end(), part.begin(), part.end());
  }
  Bytes rows((1 + row_bytes) * static_cast<std::size_t>(height));
  auto* const decompressor = libdeflate_alloc_decompressor();
  EXPECT_EQ(libdeflate_zlib_decompress(decompressor, stream.data(), stream.size(), rows.data(),
                                       rows.size(), nullptr),
            LIBDEFLATE_SUCCESS);
  libdeflate_free_decompressor(decompressor);
}

/// Writes `image` by threads in any order and by one: OpenCV reads it, the same file both times.
/// Returns the file.
template <typename T>
Bytes written(const Image<T>& image, Execution& execution) {
  Bytes bytes = {1, 2, 3};  // of another file
  encode_png(image, bytes, &execution);
  Bytes of_one_thread;
  encode_png(image, of_one_thread);
  EXPECT_EQ(bytes, of_one_thread);
  expect_checksums(bytes, sizeof(T) * static_cast<std::size_t>(image.width() * image.channels()),
                   image.height());
  const Image<T> read = read_by_opencv<T>(bytes);
  const bool has_shape = read.width() == image.width() && read.height() == image.height() &&
                         read.channels() == image.channels();
  EXPECT_TRUE(has_shape);
  for (int y = 0; has_shape && y < image.height(); ++y) {
    EXPECT_TRUE(
        std::equal(image.row(y), image.row(y) + image.width() * image.channels(), read.row(y)))
        << "row " << y;
  }
  return bytes;
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
class PngEncoder : public testing::Test {
 protected:
  Execution execution_{ExecutionOptions{.threads = 3}};
};
using Depths = testing::Types<std::uint8_t, std::uint16_t>;
TYPED_TEST_SUITE(PngEncoder, Depths);

TYPED_TEST(PngEncoder, OpenCvReadsAnySizeAndEachNumberOfChannels) {
  // The last two have several strips in most of the formats.
  for (const auto& [width, height] : std::initializer_list<std::array<int, 2>>{
           {1, 1}, {1, 7}, {13, 1}, {67, 19}, {257, 300}, {1400, 96}}) {
    for (const int channels : {1, 3, 4}) {
      SCOPED_TRACE(testing::Message() << width << "x" << height << "x" << channels);
      const auto image = picture<TypeParam>(width, height, channels);
      // Noise grows by little.
      const std::size_t row_bytes =
          1 + sizeof(TypeParam) * static_cast<std::size_t>(width * channels);
      EXPECT_LT(written(image, this->execution_).size(), row_bytes * height * 1003 / 1000 + 300);
    }
  }
}

TYPED_TEST(PngEncoder, RunsOfEveryLength) {
  // Zeros after the filter: from a row of its own to rows without any change. A match holds up to
  // 258 bytes, and at least 3.
  Image<TypeParam> image(900, 700);
  image.fill(7);
  for (int y = 0; y < 690; ++y) {
    image.at(y, y) = static_cast<TypeParam>(y);
    image.at(899 - y % 300, y) = 90;
  }
  EXPECT_LT(written(image, this->execution_).size(), 20000U);
  image.fill(0);
  EXPECT_LT(written(image, this->execution_).size(), 7000U);
}

TYPED_TEST(PngEncoder, CodesThatWouldBeTooLong) {
  // Differences as frequent as Fibonacci's numbers have Huffman codes of up to 22 bits.
  Image<TypeParam> image(300, 200);
  int x = 0;
  int times = 1;
  int times_before = 1;
  TypeParam value = 0;
  TypeParam step = 1;
  for (int i = 0; i < 300 * 200; ++i, ++x) {
    if (x == times) {
      x = 0;
      step = static_cast<TypeParam>(step + 2);
      times = std::exchange(times_before, times_before + times);
    }
    image.at(i % 300, i / 300) = value = static_cast<TypeParam>(value + step);
  }
  written(image, this->execution_);
}

/// Bytes of PNG's filter Sub, compressed by libdeflate as before.
std::size_t searched_size(const Image<std::uint16_t>& image) {
  Bytes filtered;
  for (int y = 0; y < image.height(); ++y) {
    filtered.push_back(1);
    for (int x = 0; x < image.width(); ++x) {
      const int before = x == 0 ? 0 : image.at(x - 1, y);
      filtered.push_back(static_cast<std::uint8_t>((image.at(x, y) >> 8) - (before >> 8)));
      filtered.push_back(static_cast<std::uint8_t>(image.at(x, y) - before));
    }
  }
  Bytes memory(2 * filtered.size() + 100);
  auto* const compressor = libdeflate_alloc_compressor(1);
  const std::size_t size = libdeflate_zlib_compress(compressor, filtered.data(), filtered.size(),
                                                    memory.data(), memory.size());
  libdeflate_free_compressor(compressor);
  return size;
}

TEST(PngEncoderSize, MapsAreAsSmallAsWithASearchForMatches) {
  Execution execution{ExecutionOptions{.threads = 2}};
  Image<std::uint16_t> map(640, 480);
  std::mt19937 random(3);
  for (const auto [x, y] : positions_of({0, 640}, {0, 480})) {
    const double surface = x / 160 % 2 == 0 ? 20 + 0.01 * x + 0.02 * y : 60;
    const double noise_px = x < 480 ? std::ldexp(random(), -36) : 0;  // up to 1/16
    map.at(x, y) = static_cast<std::uint16_t>(256 * (surface + noise_px));
  }
  EXPECT_LT(written(map, execution).size(), searched_size(map) * 105 / 100);
}

TEST(PngEncoderSize, NothingOfAnImageWiderThanLibpngWrites) {
  Bytes bytes = {1, 2, 3};
  encode_png(Image<std::uint8_t>(1000001, 1, 1), bytes);
  EXPECT_TRUE(bytes.empty());
}

}  // namespace vantage::png_encoder_test
