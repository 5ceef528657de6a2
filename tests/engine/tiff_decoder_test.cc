#include "engine/io/images/tiff_decoder.h"

#include <tiffio.h>

#include <opencv2/core.hpp>

#include "engine/io/files/atomic_file.h"
#include "engine/io/images/photograph_io.h"
#include "engine/io/maps/map_io.h"
#include "tests/engine/engine_test.h"

namespace vantage::tiff_decoder_test {

constexpr int kWidth = 37;
constexpr int kHeight = 21;

/// How a page is stored.
struct Page {
  int samples = 1;
  int bits = 8;
  int format = SAMPLEFORMAT_UINT;
  int photometric = PHOTOMETRIC_MINISBLACK;
  int planar = PLANARCONFIG_CONTIG;
  int tile = 0;  ///< side; 0: strips of 8 rows
  int compression = COMPRESSION_NONE;
  int orientation = 1;
  std::vector<std::uint16_t> extra = {};
  std::uint32_t kind = 0;
  std::string no_data = {};
};

/// A number for each sample that all types hold but signed bytes, 0 to 249.
int value_at(int x, int y, int sample) { return (x * 7 + y * 13 + sample * 50) % 250; }

/// A file by libtiff itself.
class TiffWriter {
 public:
  TiffWriter(const std::filesystem::path& path, const char* mode)
      : tiff_(TIFFOpen(path.c_str(), mode)) {
    TIFFMergeFieldInfo(tiff_, kNoDataField.data(), 1);
  }
  TiffWriter(const TiffWriter&) = delete;
  TiffWriter& operator=(const TiffWriter&) = delete;
  ~TiffWriter() { TIFFClose(tiff_); }

  template <typename T, typename ValueAt>
  void write(const Page& page, const ValueAt& value) {
    set(TIFFTAG_IMAGEWIDTH, kWidth);
    set(TIFFTAG_IMAGELENGTH, kHeight);
    set(TIFFTAG_SAMPLESPERPIXEL, page.samples);
    set(TIFFTAG_BITSPERSAMPLE, page.bits);
    set(TIFFTAG_SAMPLEFORMAT, page.format);
    set(TIFFTAG_PHOTOMETRIC, page.photometric);
    set(TIFFTAG_PLANARCONFIG, page.planar);
    set(TIFFTAG_COMPRESSION, page.compression);
    set(TIFFTAG_ORIENTATION, page.orientation);
    set(TIFFTAG_SUBFILETYPE, static_cast<int>(page.kind));
    if (!page.extra.empty()) {
      TIFFSetField(tiff_, TIFFTAG_EXTRASAMPLES, static_cast<int>(page.extra.size()),
                   page.extra.data());
    }
    if (!page.no_data.empty()) {
      TIFFSetField(tiff_, kNoData, page.no_data.c_str());
    }
    const int columns = page.tile > 0 ? page.tile : kWidth;
    const int rows = page.tile > 0 ? page.tile : 8;
    if (page.tile > 0) {
      set(TIFFTAG_TILEWIDTH, columns);
      set(TIFFTAG_TILELENGTH, rows);
    } else {
      set(TIFFTAG_ROWSPERSTRIP, rows);
    }
    const bool is_planar = page.planar == PLANARCONFIG_SEPARATE;
    const int together = is_planar ? 1 : page.samples;
    std::uint32_t number = 0;
    for (int plane = 0; plane < (is_planar ? page.samples : 1); ++plane) {
      for (int y0 = 0; y0 < kHeight; y0 += rows) {
        for (int x0 = 0; x0 < kWidth; x0 += columns) {
          std::vector<T> chunk;
          const int last = page.tile > 0 ? y0 + rows : std::min(y0 + rows, kHeight);
          for (int y = y0; y < last; ++y) {
            for (int x = x0; x < x0 + columns; ++x) {
              for (int s = 0; s < together; ++s) {
                chunk.push_back(static_cast<T>(value(x, y, plane + s)));
              }
            }
          }
          const auto bytes = static_cast<tmsize_t>(chunk.size() * sizeof(T));
          if (page.tile > 0) {
            TIFFWriteEncodedTile(tiff_, number++, chunk.data(), bytes);
          } else {
            TIFFWriteEncodedStrip(tiff_, number++, chunk.data(), bytes);
          }
        }
      }
    }
    TIFFWriteDirectory(tiff_);
  }

 private:
  static constexpr std::uint32_t kNoData = 42113;
  static inline const std::array<TIFFFieldInfo, 1> kNoDataField = {
      {{kNoData, -1, -1, TIFF_ASCII, FIELD_CUSTOM, 1, 0, const_cast<char*>("GDALNoDataValue")}}};

  void set(std::uint32_t tag, int value) { TIFFSetField(tiff_, tag, value); }

  TIFF* tiff_;
};

template <typename T>
Photograph written_and_read(const Page& page, const char* mode = "w",
                            const PhotographReading& reading = {}) {
  const TemporaryFolder folder;
  TiffWriter(folder / "a.tif", mode).write<T>(page, value_at);
  return read_photograph(folder / "a.tif", reading);
}

/// `expected(x, y, channel)` of each pixel, exactly.
template <typename Expected>
void expect_values(const Photograph& photograph, int channels, const Expected& expected) {
  ASSERT_EQ(photograph.channels(), channels);
  ASSERT_EQ(photograph.width(), kWidth);
  ASSERT_EQ(photograph.height(), kHeight);
  std::visit(
      [&](const auto& image) {
        for (const auto [x, y] : positions_of(kWidth, kHeight)) {
          for (int c = 0; c < channels; ++c) {
            ASSERT_EQ(static_cast<double>(image.at(x, y, c)),
                      static_cast<double>(expected(x, y, c)))
                << x << ", " << y << ", " << c;
          }
        }
      },
      photograph.pixels);
}

template <typename T>
void expect_kind(int format, std::size_t type) {
  for (const char* mode : {"w", "w8", "wb", "w8b"}) {  // b: big-endian
    for (const int planar : {PLANARCONFIG_CONTIG, PLANARCONFIG_SEPARATE}) {
      for (const int tile : {0, 16}) {
        SCOPED_TRACE(testing::Message() << sizeof(T) << " bytes, format " << format << ", " << mode
                                        << ", planar " << planar << ", tile " << tile);
        const Page page{.samples = 3,
                        .bits = 8 * sizeof(T),
                        .format = format,
                        .photometric = PHOTOMETRIC_RGB,
                        .planar = planar,
                        .tile = tile,
                        .compression = tile > 0 ? COMPRESSION_LZW : COMPRESSION_NONE};
        const Photograph photograph = written_and_read<T>(page, mode);
        EXPECT_EQ(photograph.pixels.index(), type);
        expect_values(photograph, 3,
                      [](int x, int y, int c) { return static_cast<T>(value_at(x, y, c)); });
      }
    }
  }
}

TEST(TiffDecoder, ReadsEveryKindOfNumber) {
  expect_kind<std::uint8_t>(SAMPLEFORMAT_UINT, 0);
  expect_kind<std::uint16_t>(SAMPLEFORMAT_UINT, 1);
  expect_kind<std::uint32_t>(SAMPLEFORMAT_UINT, 2);
  expect_kind<std::uint64_t>(SAMPLEFORMAT_UINT, 2);
  expect_kind<std::int8_t>(SAMPLEFORMAT_INT, 2);
  expect_kind<std::int16_t>(SAMPLEFORMAT_INT, 2);
  expect_kind<std::int32_t>(SAMPLEFORMAT_INT, 2);
  expect_kind<std::int64_t>(SAMPLEFORMAT_INT, 2);
  expect_kind<float>(SAMPLEFORMAT_IEEEFP, 2);
  expect_kind<double>(SAMPLEFORMAT_IEEEFP, 2);
}

TEST(TiffDecoder, ReadsHalfFloatsAndNegativeNumbers) {
  const TemporaryFolder folder;
  TiffWriter(folder / "a.tif", "w")
      .write<std::uint16_t>({.bits = 16, .format = SAMPLEFORMAT_IEEEFP}, [](int x, int y, int) {
        std::uint16_t bits = 0;
        const cv::float16_t half(static_cast<float>(value_at(x, y, 0)) / 256 - 0.5F);
        std::memcpy(&bits, &half, sizeof(bits));
        return bits;
      });
  expect_values(read_photograph(folder / "a.tif"), 1,
                [](int x, int y, int) { return value_at(x, y, 0) / 256.0 - 0.5; });
  TiffWriter(folder / "b.tif", "w")
      .write<std::int16_t>({.bits = 16, .format = SAMPLEFORMAT_INT},
                           [](int x, int y, int) { return value_at(x, y, 0) - 100; });
  expect_values(read_photograph(folder / "b.tif"), 1,
                [](int x, int y, int) { return value_at(x, y, 0) - 100; });
}

TEST(TiffDecoder, ZeroMayBeWhite) {
  expect_values(written_and_read<std::uint8_t>({.photometric = PHOTOMETRIC_MINISWHITE}), 1,
                [](int x, int y, int) { return 255 - value_at(x, y, 0); });
  const Page deep{.bits = 16, .photometric = PHOTOMETRIC_MINISWHITE};
  expect_values(written_and_read<std::uint16_t>(deep), 1,
                [](int x, int y, int) { return 65535 - value_at(x, y, 0); });
}

TEST(TiffDecoder, RefusesNumbersOfOtherSizes) {
  EXPECT_THAT(error_of([] { written_and_read<std::uint32_t>({.bits = 24}); }),
              HasSubstr("holds values of an unsupported type (24 bits), expected"));
}

TEST(TiffDecoder, ReadsColourOrTheMeanOfMoreBandsOrTheOneAskedFor) {
  const Page colour{.samples = 5, .photometric = PHOTOMETRIC_RGB, .extra = {0, 0}};
  const Photograph first_three = written_and_read<std::uint8_t>(colour);
  expect_values(first_three, 3, value_at);
  ASSERT_EQ(first_three.origin.remarks.size(), 1U);
  EXPECT_THAT(first_three.origin.remarks[0].text, HasSubstr("bands 1 to 3 of 5"));

  for (const int planar : {PLANARCONFIG_CONTIG, PLANARCONFIG_SEPARATE}) {
    const Page grey{.samples = 4, .bits = 16, .planar = planar, .extra = {0, 0, 0}};
    const Photograph mean = written_and_read<std::uint16_t>(grey);
    expect_values(mean, 1, [](int x, int y, int) {
      const int sum = value_at(x, y, 0) + value_at(x, y, 1) + value_at(x, y, 2) + value_at(x, y, 3);
      return (sum + 2) / 4;
    });
    EXPECT_THAT(mean.origin.remarks.at(0).text, HasSubstr("mean of 4 bands"));
    const Photograph fourth = written_and_read<std::uint16_t>(grey, "w", {.band = 4});
    expect_values(fourth, 1, [](int x, int y, int) { return value_at(x, y, 3); });
    EXPECT_TRUE(fourth.origin.remarks.empty());
    EXPECT_THAT(error_of([&] { written_and_read<std::uint16_t>(grey, "w", {.band = 5}); }),
                HasSubstr("has 4 bands"));
  }
  const Page with_alpha{
      .samples = 4, .photometric = PHOTOMETRIC_RGB, .extra = {EXTRASAMPLE_UNASSALPHA}};
  expect_values(written_and_read<std::uint8_t>(with_alpha), 4, value_at);
}

TEST(TiffDecoder, ReadsThePageAskedFor) {
  const TemporaryFolder folder;
  {
    TiffWriter writer(folder / "a.tif", "w8");
    const auto page = [&](int first, std::uint32_t kind) {
      writer.write<std::uint8_t>({.kind = kind},
                                 [&](int x, int y, int) { return value_at(x, y, 0) + first; });
    };
    page(0, 0);
    page(3, FILETYPE_REDUCEDIMAGE);  // no page of its own
    page(1, FILETYPE_PAGE);
  }
  const auto page = [&](const char* name) { return read_photograph(folder / name); };
  const auto of = [](int first) {
    return [first](int x, int y, int) { return value_at(x, y, 0) + first; };
  };
  expect_values(page("a.tif"), 1, of(0));
  EXPECT_THAT(page("a.tif").origin.remarks.at(0).text, HasSubstr("first of 2 pages"));
  expect_values(page("a.tif#0"), 1, of(0));
  EXPECT_TRUE(page("a.tif#0").origin.remarks.empty());
  expect_values(page("a.tif#1"), 1, of(1));
  EXPECT_THAT(error_of([&] { page("a.tif#2"); }), HasSubstr("has 2 pages, expected number 2"));
}

TEST(TiffDecoder, LeavesOutPixelsWithoutData) {
  const TemporaryFolder folder;
  const auto is_gap = [](int x, int y) { return x < 5 || (x == 20 && y > 10); };
  const auto expect_gaps = [&](const Photograph& photograph) {
    ASSERT_FALSE(photograph.left_out.empty());
    for (const auto [x, y] : positions_of(kWidth, kHeight)) {
      ASSERT_EQ(photograph.left_out.at(x, y) != 0, is_gap(x, y)) << x << ", " << y;
    }
    EXPECT_THAT(photograph.origin.remarks.at(0).text, HasSubstr("are left out"));
  };
  TiffWriter(folder / "a.tif", "w")
      .write<float>({.bits = 32, .format = SAMPLEFORMAT_IEEEFP}, [&](int x, int y, int) {
        return is_gap(x, y) ? std::numeric_limits<float>::quiet_NaN() : 0.5F;
      });
  expect_gaps(read_photograph(folder / "a.tif"));
  TiffWriter(folder / "b.tif", "w")
      .write<std::int16_t>({.bits = 16, .format = SAMPLEFORMAT_INT, .no_data = "-9999"},
                           [&](int x, int y, int) { return is_gap(x, y) ? -9999 : x; });
  expect_gaps(read_photograph(folder / "b.tif"));
  const DisparityMap map = read_disparity(folder / "b.tif", 1);
  for (const auto [x, y] : positions_of(kWidth, kHeight)) {
    ASSERT_EQ(std::isnan(map.at(x, y)), is_gap(x, y)) << x << ", " << y;
    ASSERT_TRUE(is_gap(x, y) || map.at(x, y) == static_cast<float>(x));
  }
  TiffWriter(folder / "c.tif", "w")
      .write<float>({.bits = 32, .format = SAMPLEFORMAT_IEEEFP},
                    [](int, int, int) { return std::numeric_limits<float>::quiet_NaN(); });
  EXPECT_THAT(error_of([&] { read_photograph(folder / "c.tif"); }), HasSubstr("no pixel has data"));
}

TEST(TiffDecoder, ScalesTwelveBitsToSixteen) {
  const TemporaryFolder folder;
  TIFF* const tiff = TIFFOpen((folder / "a.tif").c_str(), "w");
  for (const auto& [tag, value] : {std::pair(TIFFTAG_IMAGEWIDTH, 3),
                                   {TIFFTAG_IMAGELENGTH, 1},
                                   {TIFFTAG_BITSPERSAMPLE, 12},
                                   {TIFFTAG_SAMPLESPERPIXEL, 1},
                                   {TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK}}) {
    TIFFSetField(tiff, static_cast<std::uint32_t>(tag), value);
  }
  std::array<std::uint8_t, 5> packed = {0x12, 0x3F, 0xFF, 0x80, 0x00};
  TIFFWriteEncodedStrip(tiff, 0, packed.data(), packed.size());
  TIFFClose(tiff);
  const Photograph read = read_photograph(folder / "a.tif");
  const auto& image = std::get<Image<std::uint16_t>>(read.pixels);
  EXPECT_EQ(std::vector<int>(image.row(0), image.row(0) + 3),
            (std::vector<int>{static_cast<int>(std::lround(0x123 * 65535.0 / 4095)), 65535,
                              static_cast<int>(std::lround(0x800 * 65535.0 / 4095))}));
}

TEST(TiffDecoder, TurnsAsTheTagSays) {
  const Photograph turned = written_and_read<std::uint8_t>({.orientation = 6});
  ASSERT_EQ(turned.width(), kHeight);
  for (const auto [x, y] : positions_of(kWidth, kHeight)) {
    ASSERT_EQ(std::get<Image<std::uint8_t>>(turned.pixels).at(kHeight - 1 - y, x),
              value_at(x, y, 0));
  }
  EXPECT_EQ(turned.origin.turn, Orientation::kTurn90);
  EXPECT_EQ(
      written_and_read<std::uint8_t>({.orientation = 6}, "w", {.turns_upright = false}).width(),
      kWidth);
}

/// Luminance and chromaticity by logarithms, as renderers store them: XYZ becomes RGB.
TEST(TiffDecoder, ReadsLogLuvAsColours) {
  const TemporaryFolder folder;
  TIFF* const tiff = TIFFOpen((folder / "a.tif").c_str(), "w");
  for (const auto& [tag, value] : {std::pair(TIFFTAG_IMAGEWIDTH, 2),
                                   {TIFFTAG_IMAGELENGTH, 1},
                                   {TIFFTAG_ROWSPERSTRIP, 1},
                                   {TIFFTAG_SAMPLESPERPIXEL, 3},
                                   {TIFFTAG_BITSPERSAMPLE, 32},
                                   {TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_IEEEFP},
                                   {TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG},
                                   {TIFFTAG_COMPRESSION, COMPRESSION_SGILOG},
                                   {TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_LOGLUV},
                                   {TIFFTAG_SGILOGDATAFMT, SGILOGDATAFMT_FLOAT}}) {
    TIFFSetField(tiff, static_cast<std::uint32_t>(tag), value);
  }
  // White of D65 at a half, and the red of sRGB (first column of its matrix).
  std::array<float, 6> xyz = {0.475228F, 0.5F, 0.544529F, 0.412453F, 0.212671F, 0.019334F};
  TIFFWriteEncodedStrip(tiff, 0, xyz.data(), sizeof(xyz));
  TIFFClose(tiff);
  const Photograph read = read_photograph(folder / "a.tif");
  const auto& image = std::get<Image<float>>(read.pixels);
  const std::array<float, 6> expected = {0.5F, 0.5F, 0.5F, 1, 0, 0};
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_NEAR(image.row(0)[i], expected[i], 0.02) << i;
  }
}

TEST(TiffDecoder, RefusesTilesFarLargerThanTheImage) {
  const TemporaryFolder folder;
  TiffWriter(folder / "a.tif", "w").write<std::uint8_t>({.tile = 16}, value_at);
  auto bytes = bytes_of(folder / "a.tif");
  for (const std::uint8_t tag :
       {std::uint8_t{0x42}, std::uint8_t{0x43}}) {  // width and length of the tiles, 322 and 323
    const std::array<std::uint8_t, 4> entry = {tag, 1, 3, 0};
    const auto place = std::ranges::search(bytes, entry);
    ASSERT_FALSE(place.empty());
    const std::uint16_t side = 32000;
    std::memcpy(&*place.begin() + 8, &side, sizeof(side));
  }
  put_bytes(folder / "b.tif", bytes);
  EXPECT_THAT(error_of([&] { read_photograph(folder / "b.tif"); }),
              HasSubstr("its tiles of 32000x32000 pixels are too large"));
}

TEST(TiffDecoder, DamagedFilesAreErrorsOfOneLine) {
  const TemporaryFolder folder;
  TiffWriter(folder / "a.tif", "w8")
      .write<std::uint16_t>({.samples = 3,
                             .bits = 16,
                             .photometric = PHOTOMETRIC_RGB,
                             .planar = PLANARCONFIG_SEPARATE,
                             .tile = 16,
                             .compression = COMPRESSION_ADOBE_DEFLATE},
                            value_at);
  const auto whole = bytes_of(folder / "a.tif");
  std::mt19937 generator(3);
  for (int i = 0; i < 150; ++i) {
    auto bytes = whole;
    if (i % 3 == 0) {
      bytes.resize(generator() % whole.size());
    } else {
      // The directory is at the end.
      const std::size_t range =
          i % 3 == 1 ? bytes.size() : std::min<std::size_t>(bytes.size(), 700);
      bytes[bytes.size() - 1 - generator() % range] = static_cast<std::uint8_t>(generator());
    }
    put_bytes(folder / "b.tif", bytes);
    const std::string error = error_of([&] { read_photograph(folder / "b.tif"); });
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
  }
}

}  // namespace vantage::tiff_decoder_test
