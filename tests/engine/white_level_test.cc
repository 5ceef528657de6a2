#include "engine/image/white_level.h"

#include <libdeflate.h>

#include "engine/io/images/photograph_io.h"
#include "tests/engine/engine_test.h"

namespace vantage::white_level_test {

/// Values 0 to `largest` in steps that leave no common divisor, in the colours; alpha is full.
template <typename T>
Photograph ramp(double largest, int channels = 1) {
  Image<T> image(37, 3, channels);
  for (const auto [x, y] : positions_of(image)) {
    for (int c = 0; c < channels; ++c) {
      const double value = largest * (y * 37 + x) / 110.0;
      image.at(x, y, c) =
          c == 3 ? std::numeric_limits<T>::max()
                 : static_cast<T>(std::is_same_v<T, float> ? value : std::round(value));
    }
  }
  return {std::move(image)};
}

/// White found of both photographs, in the unit of their type.
double found(Photograph left, Photograph right) {
  WhiteLevelSearch search;
  search.add(left);
  search.add(right);
  return search.found().value;
}

TEST(WhiteLevel, IsOfTheBitsOfTheBrightestPixel) {
  for (const int bits : {8, 9, 10, 12, 14, 15, 16}) {
    const double white = std::ldexp(1.0, bits) - 1;
    const double expected = bits > 14 ? 65535 : white;
    EXPECT_EQ(found(ramp<std::uint16_t>(white), ramp<std::uint16_t>(30)), expected) << bits;
    EXPECT_EQ(found(ramp<std::uint16_t>(1), ramp<std::uint16_t>(0.6 * white, 4)), expected) << bits;
  }
  EXPECT_EQ(found(ramp<std::uint16_t>(0), ramp<std::uint16_t>(0)), 65535) << "black";
  EXPECT_EQ(found(ramp<std::uint8_t>(200), ramp<std::uint16_t>(900)), 1023) << "of 16 bits";
  EXPECT_EQ(found(ramp<std::uint8_t>(9), ramp<std::uint8_t>(5)), 255);
}

TEST(WhiteLevel, ValuesThatWereScaledTo16BitsStay) {
  const auto times = [](int largest, int factor) {
    Photograph photograph = ramp<std::uint16_t>(largest);
    auto& image = std::get<Image<std::uint16_t>>(photograph.pixels);
    for (const auto [x, y] : positions_of(image)) {
      image.at(x, y) = static_cast<std::uint16_t>(image.at(x, y) * factor);
    }
    return photograph;
  };
  EXPECT_EQ(found(times(40, 257), times(40, 257)), 65535);
  EXPECT_EQ(found(times(4000, 16), times(800, 16)), 65535);
  EXPECT_EQ(found(times(255, 16), times(255, 16)), 4095) << "8 bits in 12";
}

TEST(WhiteLevel, OfFloatsIsThatOfTheirScale) {
  for (const auto& [largest, white] : {std::pair(1.0, 1.0),
                                       {0.2, 1.0},
                                       {1.9, 1.0},
                                       {255.0, 255.0},
                                       {255e3, 262143.0},
                                       {0.01, 0.01F},
                                       {3.9, 3.0},
                                       {100.0, 127.0}}) {
    EXPECT_EQ(found(ramp<float>(largest), ramp<float>(largest / 2)), white) << largest;
  }
  Photograph highlight = ramp<float>(0.9);
  std::get<Image<float>>(highlight.pixels).at(5, 1) = 700;
  EXPECT_EQ(found(std::move(highlight), ramp<float>(0.9)), 1);
}

TEST(WhiteLevel, IsAppliedAsNetpbmDefinesIt) {
  // Independent: round(v · 65535 / white) in integers.
  Photograph photograph = ramp<std::uint16_t>(1100);
  const Photograph before = ramp<std::uint16_t>(1100);
  const double clipped = WhiteLevel{1, 1023}.apply(photograph);
  const auto& from = std::get<Image<std::uint16_t>>(before.pixels);
  const auto& to = std::get<Image<std::uint16_t>>(photograph.pixels);
  int above = 0;
  for (const auto [x, y] : positions_of(to)) {
    const unsigned value = from.at(x, y);
    above += value > 1023 ? 1 : 0;
    EXPECT_EQ(to.at(x, y), value > 1023 ? 65535U : (2 * value * 65535 + 1023) / (2 * 1023));
  }
  EXPECT_GT(above, 0);
  EXPECT_DOUBLE_EQ(clipped, above / 111.0);
  EXPECT_EQ(photograph.origin.white_level, 65535);
}

TEST(WhiteLevel, GivenOnesAreCheckedWithTheType) {
  for (const double wrong : {70000.0, 0.0, -1.0, std::nan(""), HUGE_VAL}) {
    WhiteLevelSearch search(wrong);
    search.add(ramp<std::uint16_t>(900));
    EXPECT_THAT(error_of([&] { (void)search.found(); }),
                HasSubstr("expected above 0 and at most 65535, the largest value of the images"));
  }
  Photograph floats = ramp<float>(20);
  Photograph* const both[] = {&floats, &floats};
  EXPECT_THAT(scale_to_white_level({both, 1}, 20), IsEmpty());
  EXPECT_FLOAT_EQ(std::get<Image<float>>(floats.pixels).at(36, 2), 1);
}

/// A classic TIFF of 16-bit grey values 0, 1, 2 … with another tag of one SHORT.
std::vector<std::uint8_t> tiff(int width, int height, unsigned tag, unsigned value) {
  std::vector<std::uint8_t> bytes = {'I', 'I', 42, 0, 8, 0, 0, 0};
  const auto put = [&](unsigned number, int count) {
    for (int i = 0; i < count; ++i) {
      bytes.push_back(static_cast<std::uint8_t>(number >> (8 * i)));
    }
  };
  const auto pixels = static_cast<unsigned>(width * height);
  const std::pair<unsigned, unsigned> fields[] = {{256, width},      {257, height},
                                                  {258, 16},         {259, 1},
                                                  {262, 1},          {273, 8 + 2 + 10 * 12 + 4},
                                                  {277, 1},          {278, height},
                                                  {279, 2 * pixels}, {tag, value}};
  std::vector<std::pair<unsigned, unsigned>> sorted(std::begin(fields), std::end(fields));
  std::sort(sorted.begin(), sorted.end());
  put(10, 2);
  for (const auto& [name, number] : sorted) {
    put(name, 2);
    put(3, 2);
    put(1, 4);
    put(number, 4);
  }
  put(0, 4);
  for (unsigned i = 0; i < pixels; ++i) {
    put(i, 2);
  }
  return bytes;
}

/// A 16-bit PNG of a ramp with an sBIT chunk after its header.
std::vector<std::uint8_t> png(double largest, const std::vector<std::uint8_t>& content) {
  std::vector<std::uint8_t> bytes;
  encode_photograph("a.png", ramp<std::uint16_t>(largest), bytes);
  std::vector<std::uint8_t> chunk;
  const std::string name = "sBIT";
  const auto put = [&](std::uint32_t number) {
    for (int shift = 24; shift >= 0; shift -= 8) {
      chunk.push_back(static_cast<std::uint8_t>(number >> shift));
    }
  };
  put(static_cast<std::uint32_t>(content.size()));
  chunk.insert(chunk.end(), name.begin(), name.end());
  chunk.insert(chunk.end(), content.begin(), content.end());
  put(libdeflate_crc32(0, chunk.data() + 4, chunk.size() - 4));
  bytes.insert(bytes.begin() + 8 + 25, chunk.begin(), chunk.end());
  return bytes;
}

std::optional<double> stated_by(const std::vector<std::uint8_t>& bytes, const char* name) {
  const TemporaryFolder folder;
  put_bytes(folder / name, bytes);
  return read_photograph(folder / name).origin.white_level;
}

TEST(StatedWhiteLevel, IsReadFromTiffTags) {
  constexpr unsigned kMaxSampleValue = 281;
  constexpr unsigned kWhiteLevel = 50717;
  EXPECT_EQ(stated_by(tiff(20, 10, kWhiteLevel, 4000), "a.tif"), 4000);
  EXPECT_EQ(stated_by(tiff(20, 10, kMaxSampleValue, 900), "a.tif"), 1023);
  EXPECT_EQ(stated_by(tiff(20, 10, kMaxSampleValue, 65535), "a.tif"), std::nullopt);
  EXPECT_EQ(stated_by(tiff(20, 10, kWhiteLevel, 0), "a.tif"), std::nullopt);
  std::vector<std::uint8_t> beyond = tiff(20, 10, kWhiteLevel, 0);
  const std::size_t entry = 8 + 2 + 9 * 12;  // of five values, far beyond the end
  beyond[entry + 4] = 5;
  beyond[entry + 10] = 200;
  EXPECT_EQ(stated_by(beyond, "a.tif"), std::nullopt);  // as if the tag were not there
}

TEST(StatedWhiteLevel, IsReadFromPng) {
  EXPECT_EQ(stated_by(png(900, {12, 10, 11}), "a.png"), 4095);
  for (const auto& damaged : std::vector<std::vector<std::uint8_t>>{{}, {0}, {16}, {255, 255}}) {
    EXPECT_EQ(stated_by(png(900, damaged), "a.png"), std::nullopt);
  }
}

TEST(StatedWhiteLevel, CountsUnlessValuesAreAboveIt) {
  const auto of_pair = [](double left, std::optional<double> right) {
    Photograph pair[] = {ramp<std::uint16_t>(900), ramp<std::uint16_t>(1500)};
    pair[0].origin.white_level = left;
    pair[1].origin.white_level = right;
    WhiteLevelSearch search;
    search.add(pair[0]);
    search.add(pair[1]);
    return search.found();
  };
  EXPECT_EQ(of_pair(4000, std::nullopt).value, 4000);
  EXPECT_EQ(of_pair(1023, 65535.0).value, 65535);
  EXPECT_EQ(of_pair(1023, std::nullopt).value, 2047);
  EXPECT_THAT(of_pair(4095, 4095.0).remarks.at(0).text,
              "white level: 4095 (12 bits), as the files say");
}

TEST(StatedWhiteLevel, OfNetpbmIsAppliedByTheReader) {
  const auto text = [](const std::string& pgm) {
    return std::vector<std::uint8_t>(pgm.begin(), pgm.end());
  };
  EXPECT_EQ(stated_by(text("P2 2 1 1023\n0 1023"), "a.pgm"), 65535);
  EXPECT_EQ(stated_by(text("P2 2 1 65535\n0 1023"), "a.pgm"), std::nullopt) << "any writer says so";
}

}  // namespace vantage::white_level_test
