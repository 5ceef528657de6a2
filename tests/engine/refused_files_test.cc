// Files and requests that readers and writers refuse, each by the message that says why.

#include <libdeflate.h>

#include <opencv2/imgcodecs.hpp>

#include "engine/io/files/atomic_file.h"
#include "engine/io/images/netpbm.h"
#include "engine/io/images/photograph_io.h"
#include "engine/io/images/png_decoder.h"
#include "engine/io/maps/map_io.h"
#include "engine/io/maps/npy.h"
#include "engine/io/video/frame_source.h"
#include "engine/io/video/video_io.h"
#include "engine/io/video/writing/video_join.h"
#include "tests/engine/engine_test.h"
#include "tests/engine/video_test_support.h"

namespace vantage::refused_files_test {

using std::string_literals::operator""s;

class RefusedFiles : public testing::Test {
 protected:
  /// What reading `bytes` as an image or a map says.
  [[nodiscard]] std::string problem(const std::string& bytes, const char* name = "a") const {
    put_text(folder_ / name, bytes);
    return error_of([&] {
      std::string(name).ends_with(".npy") ? void(read_disparity(folder_ / name))
                                          : void(read_photograph(folder_ / name));
    });
  }
  template <typename Decode>
  static std::string problem_of(const Decode& decode, const std::string& text) {
    const std::vector<std::uint8_t> bytes(text.begin(), text.end());
    return error_of([&] { decode(FileBytes(bytes, "a")); });
  }
  [[nodiscard]] std::string text_of(const char* name) const {
    const auto bytes = bytes_of(folder_ / name);
    return {bytes.begin(), bytes.end()};
  }

  TemporaryFolder folder_;
};

TEST_F(RefusedFiles, HeadersOfImages) {
  EXPECT_THAT(problem("BM"s + std::string(12, '\0') + "\x0C\0\0\0\0\0\5\0\1\0\30\0"s),
              HasSubstr("0x5 pixels"));  // OS/2's header
  const std::string window =
      "dataWindow\0box2i\0\x10\0\0\0"s + std::string(8, '\0') + "\3\0\0\0\3\0\0\0"s;
  EXPECT_THAT(
      problem("\x76\x2f\x31\x01\2\0\0\0compression\0compression\0\1\0\0\0\x4D"s + window + "\0"s),
      HasSubstr("EXR compression 77 does not exist"));
  const std::string jp2 = "\0\0\0\x0CjP  \r\n\x87\n"s;
  EXPECT_THAT(problem(jp2 + "\0\0\0\1jp2c\0\0\0\0\0\0\0\x20no code stream.."s),
              HasSubstr("its JPEG 2000 codestream has no header"));
  struct Refused {
    std::string bytes;
    const char* says;
  };
  const std::vector<Refused> all = {
      {"BM"s + std::string(12, '\0') + "\x28\0\0\0\1\0\0\0\1\0\0\0\1\0\x21\0"s +
           std::string(24, '\0'),
       "33 bits per pixel, expected at most 32"},
      {"\xFF\xD8\xFF\xD9"s + std::string(8, '\0'), "expected a JPEG frame header and a scan"},
      {"\x76\x2f\x31\x01\2\0\0\0\0"s, "its EXR header has no data window"},
      {jp2 + "\0\0\0\4jp2h\0\0\0\0"s, "its JPEG 2000 boxes hold no codestream"},
      {"\x89PNG\r\n\x1a\n\0\0\0\0IDAT\0\0\0\0"s, "expected one IHDR chunk of 13 bytes"},
      {"P1\n2 1\n12", "its data at pixel (1, 0) is neither 0 nor 1"},
      {"P5\n" + std::string(70, '7'), "its header is not text"}};
  for (const Refused& one : all) {
    EXPECT_THAT(problem(one.bytes), HasSubstr(one.says));
  }
  for (const char* end : {"P5\n2 1\n255", "Pf\n1 1\n-1"}) {
    EXPECT_THAT(problem(end), HasSubstr("truncated")) << end;
  }
  put_text(folder_ / "large", "P5\n");
  std::filesystem::resize_file(folder_ / "large", std::uintmax_t{1} << 33U);
  EXPECT_THAT(error_of([&] { read_photograph(folder_ / "large"); }),
              HasSubstr("has 8589934592 bytes, too many for an image"));
  // Readers of one format say so where they are given another.
  EXPECT_THAT(problem_of(decode_pnm, "P7 1 1"), HasSubstr("is not a PNM file"));
  EXPECT_THAT(problem_of(decode_pfm, "P5 1 1"), HasSubstr("is not a PFM file"));
  EXPECT_THAT(problem_of(decode_npy, "P5 1 1"), HasSubstr("is not a NumPy array file"));
}

TEST_F(RefusedFiles, HeadersOfArrays) {
  const auto array = [](const std::string& dictionary) {
    return "\x93NUMPY\1\0"s + static_cast<char>(dictionary.size()) + '\0' + dictionary;
  };
  EXPECT_THAT(problem(array("{'descr': '<f4', 'fortran_order': False, 'shape': (3, 4"), "a.npy"),
              HasSubstr("its NPY header is not a Python dictionary"));
  EXPECT_THAT(problem(array("{'descr': '<f4', 'fortran_order': False, 'shape'  }"), "a.npy"),
              HasSubstr("its NPY header has no usable 'shape' entry"));
  for (const std::string shape : {"(3; 4)", "(3, -4)"}) {
    const std::string dictionary =
        "{'descr': '<f4', 'fortran_order': False, 'shape': " + shape + "}";
    EXPECT_THAT(problem(array(dictionary), "a.npy"),
                HasSubstr("has shape " + shape + ", expected (height, width)"));
  }
  EXPECT_THAT(problem("\x93NUMPY\2\0\xFF\xFF\xFF\x7F"s, "a.npy"),
              HasSubstr("of 2147483647 bytes is longer than that of a plain array"));
}

/// With the checksum of the `bytes` at `type` behind them.
std::string with_checksum(std::string png, std::size_t type, std::size_t bytes) {
  const std::uint32_t crc = libdeflate_crc32(0, png.data() + type, bytes);
  for (std::size_t i = 0; i < 4; ++i) {
    png[type + bytes + i] = static_cast<char>(crc >> (24 - 8 * i));
  }
  return png;
}

TEST_F(RefusedFiles, ChunksOfPng) {
  constexpr std::size_t kBehindHeader = 33;
  Image<std::uint8_t> colours(2, 1, 3);
  colours.fill(9);
  colours.at(1, 0, 2) = 200;
  write_photograph(folder_ / "a.png", {std::move(colours)});
  const auto with_chunk = [&](const std::string& name, const std::string& content) {
    std::string chunk = std::string(3, '\0') + static_cast<char>(content.size()) + name + content;
    chunk = with_checksum(chunk + std::string(4, '\0'), 4, 4 + content.size());
    return text_of("a.png").insert(kBehindHeader, chunk);
  };
  EXPECT_THAT(problem(with_chunk("ABCD", "")), HasSubstr("unknown PNG chunk at byte 33"));
  // Tags beyond the end: as if there were none.
  EXPECT_EQ(problem(with_chunk("eXIf", "II*\0\xFF\xFF\0\0"s)), "");
  put_text(folder_ / "transparent", with_chunk("tRNS", "\0\x09\0\x09\0\x09"s));
  const Photograph read = read_photograph(folder_ / "transparent");
  const auto& pixels = std::get<Image<std::uint8_t>>(read.pixels);
  ASSERT_EQ(pixels.channels(), 4);
  EXPECT_EQ(pixels.at(0, 0, 3), 0);
  EXPECT_EQ(pixels.at(1, 0, 3), 255);
}

/// Checksums are right: what is refused is what they protect.
TEST_F(RefusedFiles, PngOfWrongTypesAndPixels) {
  write_photograph(folder_ / "a.png", noise<std::uint8_t>(3, 3, 1));
  std::string png = text_of("a.png");
  png[25] = 5;
  EXPECT_THAT(problem(with_checksum(png, 12, 17)),
              HasSubstr("colour type 5 with 8 bits, which does not exist"));
  // One bit a pixel is libpng's.
  cv::imwrite(folder_ / "b.png", cv::Mat(40, 70, CV_8UC1, cv::Scalar(255)),
              {cv::IMWRITE_PNG_BILEVEL, 1});
  png = text_of("b.png");
  const std::size_t data = png.find("IDAT");
  ASSERT_NE(data, std::string::npos);
  const auto size = static_cast<std::size_t>(static_cast<unsigned char>(png[data - 1]));
  std::fill_n(png.begin() + static_cast<std::ptrdiff_t>(data) + 4, size, '\x55');
  EXPECT_THAT(problem(with_checksum(png, data, 4 + size)),
              HasSubstr("its pixels cannot be decoded ("));
  // libpng's own reader, where the header's chunks were not checked before.
  png = text_of("b.png").substr(0, data + 6);
  const auto decode = [](const FileBytes& file) {
    Photograph memory;
    (void)decode_any_png(file, file.all(), memory);
  };
  EXPECT_THAT(problem_of(decode, png), HasSubstr("the data ends too early"));
}

TEST_F(RefusedFiles, WhatCannotBeWritten) {
  const auto writing = [](const auto& write) { return error_of(write); };
  EXPECT_THAT(writing([&] { write_photograph(folder_ / "a.png", {}); }),
              HasSubstr("the image has no pixels"));
  EXPECT_THAT(writing([&] { write_mask(folder_ / "a.jpg", Mask(2, 2).view()); }),
              HasSubstr("a mask is a .png file"));
  EXPECT_THAT(writing([&] { encode_pnm(noise<float>(2, 2, 1)); }),
              HasSubstr("PNM holds 8- and 16-bit values only"));
  EXPECT_THAT(writing([&] { write_text_file(folder_ / "", "x"); }),
              HasSubstr("expected a file name"));
  VideoWriter writer(folder_ / "a.mkv", 32, 32, {.coding = VideoCoding::kFfv1_16});
  EXPECT_THAT(writing([&] { writer.write(noise<std::uint8_t>(32, 32, 3)); }),
              HasSubstr("a frame of a grey video has colours or another depth"));
  EXPECT_EQ(folder_.entries(), 1U);
}

TEST_F(RefusedFiles, RequestsThatFilesDoNotMeet) {
  write_photograph(folder_ / "grey.png", noise<std::uint8_t>(3, 2, 1));
  EXPECT_THAT(error_of([&] { read_float_image(folder_ / "grey.png"); }),
              HasSubstr("holds integers, expected floats"));
  EXPECT_THAT(error_of([&] { open_frame_source(folder_ / "grey.png", {.deinterlaces = true}); }),
              HasSubstr("deinterlace has no effect on the images of"));
  write_photograph(folder_ / "p_2147483647.png", noise<std::uint8_t>(3, 2, 1));
  EXPECT_THAT(error_of([&] { open_frame_source(folder_ / "p_%d.png"); }),
              HasSubstr("number 2147483647 is too large"));
  write_disparity(folder_ / "map.pfm", DisparityMap(3, 2).view());
  std::vector<Remark> remarks;
  read_disparity(folder_ / "map.pfm", 4, &remarks);
  ASSERT_EQ(remarks.size(), 1U);
  EXPECT_THAT(remarks[0].text, HasSubstr("they are not divided by `disparity-scale`"));
}

TEST_F(RefusedFiles, SoundIsNoVideo) {
  put_changing_sound(folder_ / "sound.mkv", {2});
  const std::vector<std::filesystem::path> segments = {folder_ / "sound.mkv"};
  for (const std::string& error :
       {error_of([&] { VideoReader(folder_ / "sound.mkv"); }), error_of([&] {
          join_videos(segments, {10, 1}, {}, folder_ / "joined.mp4");
        })}) {
    EXPECT_THAT(error, AllOf(HasSubstr("sound.mkv"), HasSubstr("holds no video")));
  }
}

}  // namespace vantage::refused_files_test
