#include "engine/io/images/photograph_io.h"
#include "engine/io/files/file_bytes.h"

#include <opencv2/imgcodecs.hpp>

#include "engine/io/files/atomic_file.h"
#include "tests/engine/engine_test.h"
#include "tests/test_paths.h"
#include "tests/test_sample.h"

namespace vantage::photograph_io_test {

constexpr std::pair<int, int> kSizes[] = {{1, 1}, {1, 7}, {13, 1}, {3, 5}, {31, 17}, {67, 19}};

TEST(PhotographIo, LosslessFormatsReturnWhatWasWritten) {
  struct Case {
    const char* extension;
    bool bytes, words, floats;
    std::vector<int> channels;
  };
  const Case cases[] = {
      {".png", true, true, false, {1, 3, 4}}, {".tiff", true, true, true, {1, 3, 4}},
      {".TIF", true, true, true, {1, 3, 4}},  {".bmp", true, false, false, {1, 3}},
      {".pgm", true, true, false, {1}},       {".ppm", true, true, false, {3}},
      {".webp", true, false, false, {3}},     {".exr", false, false, true, {1, 3, 4}},
      {".pfm", false, false, true, {1, 3}}};
  const TemporaryFolder folder;
  for (const Case& c : cases) {
    for (const auto& [width, height] : kSizes) {
      for (const int channels : c.channels) {
        std::vector<Photograph> photographs;
        if (c.bytes) {
          photographs.push_back(noise<std::uint8_t>(width, height, channels));
        }
        if (c.words) {
          photographs.push_back(noise<std::uint16_t>(width, height, channels));
        }
        if (c.floats) {
          photographs.push_back(noise<float>(width, height, channels));
        }
        for (const Photograph& photograph : photographs) {
          SCOPED_TRACE(testing::Message() << c.extension << " " << width << "x" << height << "x"
                                          << channels << " depth " << photograph.pixels.index());
          const auto path = folder / (std::string("a") + c.extension);
          write_photograph(path, photograph);
          EXPECT_TRUE(same(read_photograph(path), photograph));
        }
      }
    }
  }
  EXPECT_EQ(folder.entries(), 9U);
}

TEST(PhotographIo, MemoryOfPhotographsAndFilesIsReused) {
  const TemporaryFolder folder;
  const Photograph first = noise<std::uint8_t>(40, 30, 3, 1);
  const Photograph second = noise<std::uint8_t>(40, 30, 3, 2);
  for (const char* name : {"a.png", "a.tiff"}) {
    write_photograph(folder / name, first);
    Photograph photograph = read_photograph(folder / name);
    const std::uint8_t* memory = std::get<Image<std::uint8_t>>(photograph.pixels).row(0);
    write_photograph(folder / name, second);
    photograph = read_photograph(folder / name, {}, std::move(photograph));
    EXPECT_EQ(std::get<Image<std::uint8_t>>(photograph.pixels).row(0), memory);
    EXPECT_TRUE(same(photograph, second));
    // Of another type and size.
    photograph = read_photograph(folder / name, {}, noise<std::uint16_t>(3, 2, 1));
    EXPECT_TRUE(same(photograph, second));
  }
  for (const char* name : {"a.png", "a.tiff", "a.ppm"}) {
    std::vector<std::uint8_t> bytes(100000, 7);
    encode_photograph(folder / name, second, bytes);
    write_photograph(folder / name, second);
    EXPECT_EQ(bytes, bytes_of(folder / name)) << name;
  }
  std::vector<std::uint8_t> bytes(100000, 7);
  const Photograph floats = noise<float>(9, 7, 1);
  encode_photograph(folder / "a.pfm", floats, bytes);
  write_photograph(folder / "a.pfm", floats);
  EXPECT_EQ(bytes, bytes_of(folder / "a.pfm"));
}

TEST(PhotographIo, JpegKeepsSmoothColoursAndTheirOrder) {
  const TemporaryFolder folder;
  Photograph photograph{Image<std::uint8_t>(37, 21, 3)};
  auto& image = std::get<Image<std::uint8_t>>(photograph.pixels);
  for (const auto [x, y] : positions_of(37, 21)) {
    image.at(x, y, 0) = static_cast<std::uint8_t>(100 + 3 * x);
    image.at(x, y, 1) = static_cast<std::uint8_t>(40 + 2 * y);
    image.at(x, y, 2) = 20;
  }
  write_photograph(folder / "a.jpg", photograph);
  const Photograph read = read_photograph(folder / "a.jpg");
  const auto& result = std::get<Image<std::uint8_t>>(read.pixels);
  ASSERT_EQ(result.channels(), 3);
  for (const auto [i, y] : positions_of(37 * 3, 21)) {
    EXPECT_NEAR(result.row(y)[i], image.row(y)[i], 12);
  }
}

/// OpenCV's own writer is the independent side here: its pixels are BGR.
TEST(PhotographIo, ColoursComeOutInRgbOrder) {
  const TemporaryFolder folder;
  for (const char* name : {"a.png", "a.bmp", "a.ppm", "a.tiff"}) {
    cv::imwrite(folder / name, cv::Mat(2, 3, CV_8UC3, cv::Scalar(10, 20, 30)));
    const Photograph read = read_photograph(folder / name);
    const auto& image = std::get<Image<std::uint8_t>>(read.pixels);
    EXPECT_EQ(image.at(2, 1, 0), 30) << name;
    EXPECT_EQ(image.at(2, 1, 1), 20) << name;
    EXPECT_EQ(image.at(2, 1, 2), 10) << name;
  }
}

TEST(PhotographIo, WritesWhatOpenCvReadsTheSame) {
  const TemporaryFolder folder;
  const Photograph photograph = noise<std::uint8_t>(9, 4, 3);
  const auto& image = std::get<Image<std::uint8_t>>(photograph.pixels);
  for (const char* name : {"a.png", "a.bmp", "a.ppm", "a.tiff", "a.webp"}) {
    write_photograph(folder / name, photograph);
    const cv::Mat read = cv::imread(folder / name, cv::IMREAD_UNCHANGED);
    ASSERT_EQ(read.type(), CV_8UC3) << name;
    for (int x = 0; x < 9; ++x) {
      const auto bgr = read.at<cv::Vec3b>(2, x);
      EXPECT_EQ(bgr[0], image.at(x, 2, 2)) << name;
      EXPECT_EQ(bgr[2], image.at(x, 2, 0)) << name;
    }
  }
}

TEST(PhotographIo, ReadsEveryKindOfPnm) {
  const TemporaryFolder folder;
  const auto grey = [&](const std::string& text) {
    put_text(folder / "a.pnm", text);
    return read_photograph(folder / "a.pnm");
  };
  const auto bytes = [](const Photograph& p) {
    const auto& image = std::get<Image<std::uint8_t>>(p.pixels);
    return std::vector<int>(image.row(0), image.row(0) + image.width() * image.channels());
  };
  EXPECT_EQ(bytes(grey("P2 # a comment\n3 1\n# another\n255\n0 128 255\n")),
            (std::vector<int>{0, 128, 255}));
  EXPECT_EQ(bytes(grey("P2\n3 1\n3\n0 1 3\n")), (std::vector<int>{0, 85, 255}));
  EXPECT_EQ(bytes(grey("P3\n1 1\n255\n1 2 3")), (std::vector<int>{1, 2, 3}));
  EXPECT_EQ(bytes(grey("P1\n4 1\n01 10")), (std::vector<int>{255, 0, 0, 255}));
  EXPECT_EQ(bytes(grey("P4\n3 1\n\x40")), (std::vector<int>{255, 0, 255}));
  EXPECT_EQ(bytes(grey("P5\n2 1\n255\n\x0A\x20")), (std::vector<int>{10, 32}));
  const Photograph wide = grey(std::string("P5 2 1 1023\n\x03\xFF\x00\x01", 16));
  const auto& image = std::get<Image<std::uint16_t>>(wide.pixels);
  EXPECT_EQ(image.at(0, 0), 65535);
  EXPECT_EQ(image.at(1, 0), 64);
}

/// Palette, 1-bit and grey with alpha, each 2×1, made by hand: every chunk with its checksum.
TEST(PhotographIo, ReadsPalettesBitsAndGreyAlpha) {
  const TemporaryFolder folder;
  const auto crc = [](const std::string& text) {
    std::uint32_t c = 0xFFFFFFFFU;
    for (const char byte : text) {
      c ^= static_cast<unsigned char>(byte);
      for (int bit = 0; bit < 8; ++bit) {
        c = (c >> 1) ^ ((c & 1U) * 0xEDB88320U);
      }
    }
    return ~c;
  };
  const auto word = [](std::uint32_t value) {
    return std::string{static_cast<char>(value >> 24), static_cast<char>(value >> 16),
                       static_cast<char>(value >> 8), static_cast<char>(value)};
  };
  const auto chunk = [&](const std::string& type, const std::string& data) {
    return word(static_cast<std::uint32_t>(data.size())) + type + data + word(crc(type + data));
  };
  const auto read = [&](int bits, int colour_type, const std::string& extra,
                        const std::string& raw) {
    std::uint32_t a = 1;
    std::uint32_t b = 0;
    for (const char c : raw) {
      a = (a + static_cast<unsigned char>(c)) % 65521;
      b = (b + a) % 65521;
    }
    const auto length = static_cast<char>(raw.size());
    const std::string stored = std::string("\x78\x01\x01") + length + '\0' +
                               static_cast<char>(~length) + '\xFF' + raw + word(b << 16 | a);
    const std::string header = word(2) + word(1) + static_cast<char>(bits) +
                               static_cast<char>(colour_type) + std::string(3, '\0');
    put_text(folder / "a.png", "\x89PNG\r\n\x1A\n" + chunk("IHDR", header) + extra +
                                   chunk("IDAT", stored) + chunk("IEND", ""));
    Photograph photograph = read_photograph(folder / "a.png");
    const auto& image = std::get<Image<std::uint8_t>>(photograph.pixels);
    return std::vector<int>(image.row(0), image.row(0) + 2 * image.channels());
  };
  EXPECT_EQ(read(1, 0, "", std::string("\0\x40", 2)), (std::vector<int>{0, 255}));
  EXPECT_EQ(read(8, 0, "", std::string("\0\x05\x06", 3)), (std::vector<int>{5, 6}));
  EXPECT_EQ(read(8, 3, chunk("PLTE", "abcdef"), std::string("\0\x01\x00", 3)),
            (std::vector<int>{'d', 'e', 'f', 'a', 'b', 'c'}));
  EXPECT_EQ(read(8, 4, "", std::string("\0\x05\x06\x07\x08", 5)),
            (std::vector<int>{5, 5, 5, 6, 7, 7, 7, 8}));
  // A gamma chunk must not change the values.
  EXPECT_EQ(read(8, 0, chunk("gAMA", word(100000)), std::string("\0\x05\x06", 3)),
            (std::vector<int>{5, 6}));
}

TEST(PhotographIo, ReadsJpeg2000) {
  const TemporaryFolder folder;
  cv::Mat stored(40, 70, CV_16UC1);
  cv::randu(stored, 0, 32767);  // 15 bits, as Sentinel-2 has them
  const std::vector<int> lossless = {cv::IMWRITE_JPEG2000_COMPRESSION_X1000, 1000};
  cv::imwrite(folder / "a.jp2", stored, lossless);
  const Photograph read = read_photograph(folder / "a.jp2");
  const auto& image = std::get<Image<std::uint16_t>>(read.pixels);
  for (const auto [x, y] : positions_of(70, 40)) {
    ASSERT_EQ(image.at(x, y), stored.at<std::uint16_t>(y, x)) << x << ", " << y;
  }
  auto bytes = bytes_of(folder / "a.jp2");
  const auto size = std::ranges::search(bytes, std::array<std::uint8_t, 4>{0xFF, 0x4F, 0xFF, 0x51});
  std::fill_n(size.begin() + 8, 8, std::uint8_t{0x7F});  // width and height
  put_bytes(folder / "b.jp2", bytes);
  EXPECT_THAT(error_of([&] { read_photograph(folder / "b.jp2"); }), HasSubstr("at most"));
}

TEST(PhotographIo, NamesFormatsThatAreNotRead) {
  const TemporaryFolder folder;
  const auto complaint = [&](const char* name, std::string_view bytes) {
    put_text(folder / name, std::string(bytes));
    return error_of([&] { read_photograph(folder / name); });
  };
  using std::string_view_literals::operator""sv;
  EXPECT_THAT(complaint("a",
                        "\0\0\0\x1C"
                        "ftypavif"sv),
              HasSubstr("is AVIF, which is not read"));
  EXPECT_THAT(complaint("a",
                        "\0\0\0\x1C"
                        "ftypheic"sv),
              HasSubstr("is HEIC, which is not read"));
  EXPECT_THAT(complaint("a", "GIF89a"), HasSubstr("is GIF, which is not read; convert it"));
  EXPECT_THAT(complaint("a", "SDPX"), HasSubstr("is DPX"));
  EXPECT_THAT(complaint("a.tga", "\0\0\2"sv), HasSubstr("is TGA"));
  EXPECT_THAT(complaint("a",
                        "\0\0\0\x1C"
                        "ftypisom"sv),
              HasSubstr("is a film"));
}

TEST(PhotographIo, ReadsOneBand) {
  const TemporaryFolder folder;
  const Photograph colour = noise<std::uint16_t>(5, 3, 3);
  write_photograph(folder / "a.png", colour);
  const Photograph green = read_photograph(folder / "a.png", {.band = 2});
  ASSERT_EQ(green.channels(), 1);
  EXPECT_EQ(std::get<Image<std::uint16_t>>(green.pixels).at(4, 1),
            std::get<Image<std::uint16_t>>(colour.pixels).at(4, 1, 1));
  write_photograph(folder / "a.tif", colour);
  for (const char* name : {"a.png", "a.tif"}) {
    for (const int band : {0, 4}) {
      EXPECT_THAT(error_of([&] { read_photograph(folder / name, {.band = band}); }),
                  HasSubstr("has 3 bands"));
    }
  }
}

TEST(PhotographIo, RefusesInfinityAndLeavesOutNaN) {
  const TemporaryFolder folder;
  for (const float bad :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
        -std::numeric_limits<float>::infinity()}) {
    for (const char* name : {"a.pfm", "a.tiff", "a.exr"}) {
      Photograph photograph = noise<float>(5, 4, 3);
      std::get<Image<float>>(photograph.pixels).at(3, 2, 1) = bad;
      write_photograph(folder / name, photograph);
      if (std::isnan(bad)) {
        const Photograph read = read_photograph(folder / name);
        for (const auto [x, y] : positions_of(5, 4)) {
          EXPECT_EQ(read.left_out.at(x, y), x == 3 && y == 2 ? 255 : 0);
        }
        EXPECT_EQ(std::get<Image<float>>(read.pixels).at(3, 2, 1),
                  std::get<Image<float>>(photograph.pixels).at(2, 2, 1));
        continue;
      }
      EXPECT_THAT(error_of([&] { read_photograph(folder / name); }),
                  testing::AllOf(HasSubstr(name), HasSubstr("pixel (3, 2)")));
    }
  }
}

TEST(PhotographIo, RefusesWhatIsNoImage) {
  const TemporaryFolder folder;
  EXPECT_THAT(error_of([&] { read_photograph(folder / "no.png"); }), HasSubstr("no such file"));
  EXPECT_THAT(error_of([&] { read_photograph(folder.path()); }), HasSubstr("folder"));
  put_text(folder / "empty.png", "");
  EXPECT_THAT(error_of([&] { read_photograph(folder / "empty.png"); }), HasSubstr("is empty"));
  put_text(folder / "text.png", "hello\n");
  EXPECT_THAT(error_of([&] { read_photograph(folder / "text.png"); }), HasSubstr("not an image"));
  EXPECT_THAT(error_of([&] { read_photograph("/dev/zero"); }), HasSubstr("not a regular file"));
}

TEST(PhotographIo, RefusesAbsurdSizesBeforeDecoding) {
  const TemporaryFolder folder;
  const auto refuse = [&](const std::string& text, const char* expected) {
    put_text(folder / "a", text);
    EXPECT_THAT(error_of([&] { read_photograph(folder / "a"); }), HasSubstr(expected));
  };
  refuse("Pf\n0 5\n-1\nxxxx", "0x5 pixels");
  refuse("Pf\n999999999 999999999\n-1\nxxxx", "999999999x999999999");
  refuse("Pf\n65000 65000\n-1\nxxxx", "at most");
  refuse("Pf\n1000 1000\n-1\nxxxx", "truncated");
  refuse("Pf\n-3 5\n-1\nxxxx", "width");
  refuse("Pf\n1 1\n0\nxxxx", "scale");
  refuse("P5\n70000 1\n255\nxxxx", "at most");
  refuse("P5\n1 1\n70000\nxxxx", "largest value");
  refuse("P5\n99999999999 1\n255\nx", "width");
  refuse("P2\n2 1\n7\n3 8\n", "value 8");

  write_photograph(folder / "b.png", noise<std::uint8_t>(3, 3, 3));
  auto png = bytes_of(folder / "b.png");
  png[16] = 0x7F;  // of the width; the dimensions are looked at after the checksum
  put_bytes(folder / "b.png", png);
  EXPECT_THAT(error_of([&] { read_photograph(folder / "b.png"); }), HasSubstr("checksum"));

  write_photograph(folder / "b.jpg", noise<std::uint8_t>(3, 3, 3));
  auto jpeg = bytes_of(folder / "b.jpg");
  for (std::size_t i = 0; i + 9 < jpeg.size(); ++i) {
    if (jpeg[i] == 0xFF && jpeg[i + 1] == 0xC0) {
      jpeg[i + 5] = jpeg[i + 6] = 0;
    }
  }
  put_bytes(folder / "b.jpg", jpeg);
  EXPECT_THAT(error_of([&] { read_photograph(folder / "b.jpg"); }), HasSubstr("3x0 pixels"));
}

TEST(PhotographIo, RefusesRunLengthsTooFewForThePixels) {
  const TemporaryFolder folder;
  write_photograph(folder / "a.bmp", noise<std::uint8_t>(8, 8, 1));
  auto bytes = bytes_of(folder / "a.bmp");
  bytes[30] = 1;  // runs of bytes
  for (const std::size_t side : {18U, 22U}) {
    bytes[side] = 0;
    bytes[side + 1] = 16384 >> 8;
  }
  put_bytes(folder / "a.bmp", bytes);
  EXPECT_THAT(error_of([&] { read_photograph(folder / "a.bmp"); }), HasSubstr("cannot hold"));
}

TEST(PhotographIo, RefusesTiffDataTooFewForThePixels) {
  const TemporaryFolder folder;
  write_photograph(folder / "a.tiff", noise<std::uint16_t>(8, 8, 3));
  auto bytes = bytes_of(folder / "a.tiff");
  ASSERT_EQ(bytes[0], 'I');
  const auto number = [&](std::size_t at) { return bytes[at] | bytes[at + 1] << 8; };
  const auto directory = static_cast<std::size_t>(number(4) | number(6) << 16);
  const auto set = [&](int tag, int value) {
    for (int i = 0; i < number(directory); ++i) {
      const std::size_t entry = directory + 2 + 12 * static_cast<std::size_t>(i);
      if (number(entry) == tag) {
        bytes[entry + 8] = static_cast<std::uint8_t>(value & 255);
        bytes[entry + 9] = static_cast<std::uint8_t>(value >> 8);
      }
    }
    put_bytes(folder / "a.tiff", bytes);
  };
  const auto complaint = [&] { return error_of([&] { read_photograph(folder / "a.tiff"); }); };
  EXPECT_EQ(complaint(), "");
  set(256, 16384);
  set(257, 16384);
  constexpr int kCompression = 259;
  for (const int compression : {1, 5, 7, 8, 32773}) {
    set(kCompression, compression);
    EXPECT_THAT(complaint(), testing::AllOf(HasSubstr("cannot hold"), HasSubstr("16384x16384")))
        << compression;
  }
}

TEST(PhotographIo, RefusesMorePixelsThanTheProcessAccepts) {
  const TemporaryFolder folder;
  write_photograph(folder / "a.png", noise<std::uint8_t>(10, 10, 1));
  set_max_image_pixels(99);
  EXPECT_THAT(error_of([&] { read_photograph(folder / "a.png"); }), HasSubstr("99 in all"));
  set_max_image_pixels(kMaxImagePixels);
  EXPECT_NO_THROW(read_photograph(folder / "a.png"));
  EXPECT_THROW(set_max_image_pixels(0), UsageError);
  EXPECT_THROW(set_max_image_pixels(kMaxImagePixels + 1), UsageError);
}

TEST(PhotographIo, RefusesTruncatedFilesOfEveryFormat) {
  const TemporaryFolder folder;
  for (const char* name : {"a.png", "a.jpg", "a.tiff", "a.bmp", "a.ppm", "a.webp"}) {
    write_photograph(folder / name, noise<std::uint8_t>(31, 17, 3));
  }
  write_photograph(folder / "a.pfm", noise<float>(31, 17, 3));
  write_photograph(folder / "a.exr", noise<float>(31, 17, 3));
  for (const char* name :
       {"a.png", "a.jpg", "a.tiff", "a.bmp", "a.ppm", "a.webp", "a.pfm", "a.exr"}) {
    const auto whole = bytes_of(folder / name);
    for (const std::size_t size : {std::size_t{1}, std::size_t{8}, std::size_t{20},
                                   whole.size() / 2, whole.size() * 9 / 10, whole.size() - 1}) {
      put_bytes(folder / name, {whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)});
      const std::string error = error_of([&] { read_photograph(folder / name); });
      EXPECT_THAT(error, HasSubstr(name)) << size << " of " << whole.size();
      EXPECT_EQ(error.find('\n'), std::string::npos) << error;
    }
  }
}

TEST(PhotographIo, RefusesToWriteWhatAFormatCannotHold) {
  const TemporaryFolder folder;
  const auto refuse = [&](const char* name, const Photograph& photograph, const char* expected) {
    EXPECT_THAT(error_of([&] { write_photograph(folder / name, photograph); }),
                HasSubstr(expected));
  };
  refuse("a.jpg", noise<std::uint16_t>(2, 2, 3), "16-bit");
  refuse("a.png", noise<float>(2, 2, 3), "float");
  refuse("a.exr", noise<std::uint8_t>(2, 2, 3), "8-bit");
  refuse("a.jpg", noise<std::uint8_t>(2, 2, 4), "4 channels");
  refuse("a.pgm", noise<std::uint8_t>(2, 2, 3), "3 channels");
  refuse("a.webp", noise<std::uint8_t>(16400, 1, 3), "does not fit");
  EXPECT_THROW(write_photograph(folder / "a.gif", noise<std::uint8_t>(2, 2, 3)), UsageError);
  EXPECT_THROW(write_photograph(folder / "a", noise<std::uint8_t>(2, 2, 3)), UsageError);
  EXPECT_EQ(folder.entries(), 0U);
}

TEST(PhotographIo, AMaskIsAGreyPng) {
  const TemporaryFolder folder;
  const Photograph mask = noise<std::uint8_t>(5, 3, 1);
  write_mask(folder / "m.png", std::get<Image<std::uint8_t>>(mask.pixels).view());
  EXPECT_TRUE(same(read_photograph(folder / "m.png"), mask));
}

TEST(AtomicFile, LeavesNothingWithoutCommitAndReplacesWithIt) {
  const TemporaryFolder folder;
  put_text(folder / "a.txt", "old");
  {
    const AtomicFile file(folder / "a.txt");
    EXPECT_EQ(file.temporary_path().extension(), ".txt");
    EXPECT_EQ(file.temporary_path().parent_path(), folder.path());
    put_text(file.temporary_path(), "half");
  }
  EXPECT_EQ(folder.entries(), 1U);
  EXPECT_EQ(bytes_of(folder / "a.txt").size(), 3U);
  write_text_file(folder / "a.txt", "newer");
  EXPECT_EQ(folder.entries(), 1U);
  EXPECT_EQ(bytes_of(folder / "a.txt"), (std::vector<std::uint8_t>{'n', 'e', 'w', 'e', 'r'}));
}

TEST(AtomicFile, WritesBehindALinkAndNeverReplacesADevice) {
  const TemporaryFolder folder;
  put_text(folder / "real.txt", "old");
  std::filesystem::create_symlink(folder / "real.txt", folder / "link.txt");
  write_text_file(folder / "link.txt", "new!");
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link.txt"));
  EXPECT_EQ(bytes_of(folder / "real.txt").size(), 4U);
  EXPECT_THAT(error_of([] { write_text_file("/dev/null", "x"); }), HasSubstr("/dev/null"));
}

TEST(AtomicFile, NamesTheFolderThatIsMissingOrNotWritable) {
  const TemporaryFolder folder;
  EXPECT_THAT(error_of([&] { write_text_file(folder / "no/such/a.txt", "x"); }),
              HasSubstr("no folder"));
  EXPECT_THAT(error_of([&] { write_text_file(folder.path(), "x"); }), HasSubstr("folder"));
  put_text(folder / "file", "x");
  EXPECT_THAT(error_of([&] { write_text_file(folder / "file/a.txt", "x"); }),
              HasSubstr("no folder"));
  // Root may write anywhere, but not here.
  EXPECT_NE(error_of([] { write_text_file("/proc/a.txt", "x"); }), "");
}

// Files of a folder were written by the same program: the first two of each kind tell.
TEST(PhotographIo, ReadsSharedPhotographsOfEveryFolder) {
  const std::filesystem::path data = test_paths::shared_data();
  if (!std::filesystem::is_directory(data)) {
    GTEST_SKIP() << "no photographs at " << data;
  }
  std::set<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(data)) {
    files.insert(entry.path());
  }
  std::map<std::filesystem::path, int> read;  // of a folder and an extension
  for (const std::filesystem::path& file : files) {
    const std::string extension = file.extension().string();
    if (extension != ".png" && extension != ".jpg" && extension != ".ppm" && extension != ".pgm") {
      continue;
    }
    if (++read[file.parent_path() / extension] > 2 && !runs_everything()) {
      continue;
    }
    const Photograph photograph = read_photograph(file);
    const cv::Mat reference = cv::imread(file.string(), cv::IMREAD_UNCHANGED);
    EXPECT_EQ(photograph.width(), reference.cols) << file;
    EXPECT_EQ(photograph.height(), reference.rows) << file;
    EXPECT_EQ(photograph.channels(), reference.channels()) << file;
  }
  EXPECT_FALSE(read.empty());
}

}  // namespace vantage::photograph_io_test
