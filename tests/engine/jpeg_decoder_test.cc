#include "engine/io/images/jpeg_decoder.h"

#include <cstdio>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include <jpeglib.h>  // needs <cstdio> before it

#include "engine/io/images/photograph_io.h"
#include "tests/engine/engine_test.h"

namespace vantage::jpeg_decoder_test {

using Bytes = std::vector<std::uint8_t>;

/// How a file is coded.
struct Coding {
  const char* name;
  int components;         ///< 1 grey, 3 YCbCr, 4 CMYK
  bool as_ycck = false;   ///< of CMYK
  int chroma_factor = 1;  ///< columns and rows of a chroma sample
  bool progressive = false;
  int restart_rows = 0;
};

constexpr Coding kCodings[] = {{"grey", 1},
                               {"colour", 3},
                               {"subsampled", 3, false, 2},
                               {"progressive", 3, false, 2, true},
                               {"restarts", 3, false, 2, false, 1},
                               {"cmyk", 4},
                               {"ycck", 4, true}};

Bytes encode(const Coding& coding, int width, int height) {
  jpeg_compress_struct encoder{};
  jpeg_error_mgr errors{};
  encoder.err = jpeg_std_error(&errors);
  jpeg_create_compress(&encoder);
  unsigned char* memory = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&encoder, &memory, &size);
  encoder.image_width = static_cast<JDIMENSION>(width);
  encoder.image_height = static_cast<JDIMENSION>(height);
  encoder.input_components = coding.components;
  encoder.in_color_space = coding.components == 1   ? JCS_GRAYSCALE
                           : coding.components == 3 ? JCS_RGB
                                                    : JCS_CMYK;
  jpeg_set_defaults(&encoder);
  if (coding.as_ycck) {
    jpeg_set_colorspace(&encoder, JCS_YCCK);
  }
  encoder.comp_info[0].h_samp_factor = coding.chroma_factor;
  encoder.comp_info[0].v_samp_factor = coding.chroma_factor;
  encoder.restart_in_rows = coding.restart_rows;
  if (coding.progressive) {
    jpeg_simple_progression(&encoder);
  }
  jpeg_start_compress(&encoder, TRUE);
  std::mt19937 generator(5);
  Bytes row(static_cast<std::size_t>(width * coding.components));
  for (int y = 0; y < height; ++y) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      row[i] = static_cast<std::uint8_t>(2 * i + 3 * static_cast<unsigned>(y) + generator() % 40);
    }
    JSAMPROW pointer = row.data();
    jpeg_write_scanlines(&encoder, &pointer, 1);
  }
  jpeg_finish_compress(&encoder);
  Bytes bytes(memory, memory + size);
  jpeg_destroy_compress(&encoder);
  std::free(memory);
  return bytes;
}

Photograph decode(const Bytes& bytes) {
  Photograph memory;
  return decode_jpeg(FileBytes(bytes, "a.jpg"), memory);
}

TEST(JpegDecoder, PixelsAgreeWithOpenCv) {
  for (const Coding& coding : kCodings) {
    for (const auto& [width, height] : {std::pair(1, 1), {17, 9}, {64, 48}, {131, 33}}) {
      SCOPED_TRACE(testing::Message() << coding.name << " " << width << "x" << height);
      const Bytes bytes = encode(coding, width, height);
      cv::Mat expected = cv::imdecode(bytes, cv::IMREAD_UNCHANGED);
      if (expected.channels() == 3) {
        cv::cvtColor(expected, expected, cv::COLOR_BGR2RGB);
      }
      const Photograph photograph = decode(bytes);
      const auto& image = std::get<Image<std::uint8_t>>(photograph.pixels);
      ASSERT_EQ(image.width(), expected.cols);
      ASSERT_EQ(image.height(), expected.rows);
      ASSERT_EQ(image.channels(), expected.channels());
      // Quality 75 halves the standard's 11, 12, 14, 12 and 10, rounded.
      EXPECT_DOUBLE_EQ(photograph.origin.coding.value().step_grey_levels, 6);
      for (int y = 0; y < height; ++y) {
        ASSERT_TRUE(std::equal(image.row(y), image.row(y) + width * image.channels(),
                               expected.ptr<std::uint8_t>(y)))
            << y;
      }
    }
  }
}

/// Where the compressed pixels begin.
std::size_t scan_begin(const Bytes& bytes) {
  const std::uint8_t mark[] = {0xFF, 0xDA};
  return static_cast<std::size_t>(
      std::search(bytes.begin(), bytes.end(), std::begin(mark), std::end(mark)) - bytes.begin() +
      14);
}

TEST(JpegDecoder, RefusesWhatLibjpegWouldFillUp) {
  const TemporaryFolder folder;
  const auto problem = [&](const Bytes& bytes) {
    put_bytes(folder / "a.jpg", bytes);
    return error_of([&] { read_photograph(folder / "a.jpg"); });
  };
  const Bytes whole = encode(kCodings[2], 96, 64);
  ASSERT_EQ(problem(whole), "");
  // Rows that the header promises and the scan lacks.
  Bytes high = whole;
  const std::uint8_t frame[] = {0xFF, 0xC0};
  const auto header = std::search(high.begin(), high.end(), std::begin(frame), std::end(frame));
  *(header + 5) = 640 >> 8;
  *(header + 6) = 640 & 255;
  EXPECT_THAT(problem(high), AllOf(HasSubstr("a.jpg"), HasSubstr("damaged"), HasSubstr("row")));
  // Bytes lost from the scan. What is left may look like a scan by chance.
  const std::size_t begin = scan_begin(whole);
  int found = 0;
  for (std::size_t i = 0; i < 20; ++i) {
    Bytes shorter = whole;
    const auto at =
        shorter.begin() + static_cast<std::ptrdiff_t>(begin + i * (whole.size() - begin) / 22);
    shorter.erase(at, at + 100);
    found += problem(shorter).find("damaged") != std::string::npos ? 1 : 0;
  }
  EXPECT_GE(found, 10);
}

TEST(JpegDecoder, RefusesFewBytesThatWouldTakeMuchMemory) {
  const TemporaryFolder folder;
  for (const Coding& coding : {kCodings[1], kCodings[3]}) {
    Bytes bytes = encode(coding, 16, 16);
    const std::uint8_t frame[] = {0xFF,
                                  static_cast<std::uint8_t>(coding.progressive ? 0xC2 : 0xC0)};
    const auto header = std::search(bytes.begin(), bytes.end(), std::begin(frame), std::end(frame));
    for (const int offset : {5, 7}) {
      *(header + offset) = 16384 >> 8;
      *(header + offset + 1) = 0;
    }
    put_bytes(folder / "a.jpg", bytes);
    EXPECT_THAT(error_of([&] { read_photograph(folder / "a.jpg"); }),
                AllOf(HasSubstr("cannot hold"), HasSubstr("16384x16384")));
    *(header + 1) = static_cast<std::uint8_t>(coding.progressive ? 0xCA : 0xC9);  // arithmetic
    put_bytes(folder / "b.jpg", bytes);
    EXPECT_THAT(error_of([&] { read_photograph(folder / "b.jpg"); }),
                AllOf(HasSubstr("cannot hold"), HasSubstr("16384x16384")));
  }
}

}  // namespace vantage::jpeg_decoder_test
