#include "engine/io/images/png_decoder.h"

#include "tests/engine/engine_test.h"

#include <libdeflate.h>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace vantage::png_decoder_test {

using Bytes = std::vector<std::uint8_t>;

constexpr std::array<std::array<int, 2>, 8> kSizes = {
    {{1, 1}, {1, 7}, {13, 1}, {3, 5}, {31, 17}, {67, 19}, {257, 300}, {700, 96}}};

/// Noise, or something smooth with flat parts and noise here and there.
template <typename T>
Image<T> picture(int width, int height, int channels, bool smooth) {
  Photograph photograph = noise<T>(width, height, channels);
  auto& image = std::get<Image<T>>(photograph.pixels);
  for (int y = 0; smooth && y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (int c = 0; c < channels && (x * 7 + y * 3) % 11 != 0; ++c) {
        image.at(x, y, c) = static_cast<T>(y % 5 == 0 ? 200 : x + 3 * y + c);
      }
    }
  }
  return std::move(image);
}

cv::Mat to_bgr(const cv::Mat& rgb) {
  cv::Mat bgr;
  if (rgb.channels() == 3) {
    cv::cvtColor(rgb, bgr, cv::COLOR_RGB2BGR);
  } else if (rgb.channels() == 4) {
    cv::cvtColor(rgb, bgr, cv::COLOR_RGBA2BGRA);
  } else {
    bgr = rgb;
  }
  return bgr;
}

template <typename T>
cv::Mat to_bgr(const Image<T>& image) {
  return to_bgr(cv::Mat(image.height(), image.width(),
                        CV_MAKETYPE(cv::DataType<T>::depth, image.channels()),
                        const_cast<T*>(image.row(0)), image.view().stride() * sizeof(T)));
}

std::optional<Photograph> decoded(const Bytes& bytes) {
  Photograph memory;
  return decode_usual_png(check_png_structure(FileBytes(bytes, "a.png")), memory);
}

template <typename T>
void compare_with_opencv() {
  for (const auto& [width, height] : kSizes) {
    for (const int channels : {1, 3, 4}) {
      for (const bool smooth : {false, true}) {
        SCOPED_TRACE(testing::Message() << width << "x" << height << "x" << channels
                                        << (smooth ? ", smooth" : ", noise"));
        const Photograph photograph{picture<T>(width, height, channels, smooth)};
        const auto& image = std::get<Image<T>>(photograph.pixels);
        const cv::Mat expected = to_bgr(image);
        Bytes theirs;
        for (const int strategy : {0, 1, 4}) {
          cv::imencode(".png", expected, theirs,
                       {cv::IMWRITE_PNG_COMPRESSION, 4, cv::IMWRITE_PNG_STRATEGY, strategy});
          const std::optional<Photograph> own = decoded(theirs);
          ASSERT_TRUE(own);
          ASSERT_TRUE(same(*own, photograph));
        }
      }
    }
  }
}

TEST(PngDecoder, BytesAgreeWithOpenCv) { compare_with_opencv<std::uint8_t>(); }
TEST(PngDecoder, WordsAgreeWithOpenCv) { compare_with_opencv<std::uint16_t>(); }

/// As zlib's format has it.
Bytes compressed(const Bytes& content) {
  libdeflate_compressor* compressor = libdeflate_alloc_compressor(6);
  Bytes stream(libdeflate_zlib_compress_bound(compressor, content.size()));
  stream.resize(libdeflate_zlib_compress(compressor, content.data(), content.size(), stream.data(),
                                         stream.size()));
  libdeflate_free_compressor(compressor);
  return stream;
}

/// A file whose rows have the given bytes behind the given filters.
struct HandMade {
  int width = 0;
  int height = 0;
  int bit_depth = 8;
  int colour_type = 0;
  bool interlaced = false;
  Bytes rows;  ///< each behind the number of its filter

  [[nodiscard]] Bytes file() const {
    Bytes result = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
    const auto number = [](std::size_t value) {
      return Bytes{static_cast<std::uint8_t>(value >> 24), static_cast<std::uint8_t>(value >> 16),
                   static_cast<std::uint8_t>(value >> 8), static_cast<std::uint8_t>(value)};
    };
    const auto append = [&result](const Bytes& bytes) {
      result.insert(result.end(), bytes.begin(), bytes.end());
    };
    const auto chunk = [&](const char* type, const Bytes& content) {
      append(number(content.size()));
      const std::size_t begin = result.size();
      append(Bytes(type, type + 4));
      append(content);
      append(number(libdeflate_crc32(0, result.data() + begin, result.size() - begin)));
    };
    Bytes header = number(static_cast<std::size_t>(width));
    const Bytes height_bytes = number(static_cast<std::size_t>(height));
    header.insert(header.end(), height_bytes.begin(), height_bytes.end());
    for (const int value : {bit_depth, colour_type, 0, 0, interlaced ? 1 : 0}) {
      header.push_back(static_cast<std::uint8_t>(value));
    }
    chunk("IHDR", header);
    const Bytes stream = compressed(rows);
    // In two pieces.
    const auto middle = stream.begin() + static_cast<std::ptrdiff_t>(stream.size() / 2);
    chunk("IDAT", Bytes(stream.begin(), middle));
    chunk("IDAT", Bytes(middle, stream.end()));
    chunk("IEND", {});
    return result;
  }
};

TEST(PngDecoder, EveryFilterIsUndoneAsByOpenCv) {
  std::mt19937 random(8);
  for (const int bit_depth : {8, 16}) {
    for (const auto& [colour_type, channels] :
         std::array<std::array<int, 2>, 3>{{{0, 1}, {2, 3}, {6, 4}}}) {
      for (const int width : {1, 2, 9, 40}) {
        HandMade made{width, 25, bit_depth, colour_type, false, {}};
        const int row_bytes = width * channels * bit_depth / 8;
        for (int y = 0; y < made.height; ++y) {
          // Every filter first, in the first row too, and after every other one.
          made.rows.push_back(static_cast<std::uint8_t>(y < 5 ? (y + width) % 5 : random() % 5));
          for (int i = 0; i < row_bytes; ++i) {
            made.rows.push_back(static_cast<std::uint8_t>(random()));
          }
        }
        const Bytes file = made.file();
        const std::optional<Photograph> own = decoded(file);
        ASSERT_TRUE(own);
        const cv::Mat expected = cv::imdecode(file, cv::IMREAD_UNCHANGED);
        std::visit(
            [&]<typename T>(const Image<T>& image) {
              if constexpr (!std::is_same_v<T, float>) {
                ASSERT_EQ(expected.type(), to_bgr(image).type());
                ASSERT_EQ(cv::norm(expected, to_bgr(image), cv::NORM_INF), 0)
                    << width << " columns, type " << colour_type << ", " << bit_depth << " bits";
              }
            },
            own->pixels);
      }
    }
  }
}

TEST(PngDecoder, LeavesUnusualFilesToOthers) {
  EXPECT_TRUE(decoded(HandMade{2, 1, 8, 0, false, {0, 1, 2}}.file()));
  EXPECT_FALSE(decoded(HandMade{2, 1, 8, 0, true, {0, 1, 2}}.file())) << "interlaced";
  EXPECT_FALSE(decoded(HandMade{2, 1, 8, 3, false, {0, 1, 2}}.file())) << "palette";
  EXPECT_FALSE(decoded(HandMade{2, 1, 4, 0, false, {0, 1}}.file())) << "four bits";
  EXPECT_FALSE(decoded(HandMade{1, 1, 8, 4, false, {0, 1, 2}}.file())) << "grey with alpha";
  EXPECT_FALSE(decoded(HandMade{2, 1, 8, 0, false, {5, 1, 2}}.file())) << "no such filter";
  EXPECT_FALSE(decoded(HandMade{2, 1, 8, 0, false, {0, 1}}.file())) << "too few bytes";
  EXPECT_FALSE(decoded(HandMade{2, 1, 8, 0, false, {0, 1, 2, 3}}.file())) << "too many bytes";
}

}  // namespace vantage::png_decoder_test
