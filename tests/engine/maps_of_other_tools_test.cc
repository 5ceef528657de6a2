// Maps as OpenCV, NumPy and depth cameras write them.
#include <fmt/format.h>

#include <array>
#include <opencv2/imgcodecs.hpp>

#include "engine/io/images/photograph_io.h"
#include "engine/io/maps/map_io.h"
#include "tests/engine/engine_test.h"

namespace vantage::maps_of_other_tools_test {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// A NumPy file of 2 rows and 3 columns.
std::string npy(const std::string& type, const std::string& data, const char* order = "False",
                const char* shape = "2, 3") {
  const std::string header =
      fmt::format("{{'descr': '{}', 'fortran_order': {}, 'shape': ({}), }}\n", type, order, shape);
  return std::string("\x93NUMPY\1\0", 8) + static_cast<char>(header.size()) + '\0' + header + data;
}

template <typename T>
std::string bytes_of_values(const std::array<T, 6>& values) {
  return {reinterpret_cast<const char*>(values.data()), sizeof(values)};
}

/// Expects the values row by row; NaN: unknown. Returns the remarks, joined.
std::string expect_map(const std::filesystem::path& path, double scale,
                       const std::array<float, 6>& expected) {
  std::vector<Remark> remarks;
  const DisparityMap map = read_disparity(path, scale, &remarks);
  EXPECT_EQ(map.width(), 3);
  EXPECT_EQ(map.height(), 2);
  for (int i = 0; i < 6; ++i) {
    const float read = map.at(i % 3, i / 3);
    const float value = expected[static_cast<std::size_t>(i)];
    EXPECT_TRUE(read == value || (std::isnan(read) && std::isnan(value)))
        << path << " at " << i << ": " << read << ", expected " << value;
  }
  std::string text;
  for (const Remark& remark : remarks) {
    text += remark.text + '\n';
  }
  return text;
}

TEST(MapsOfOtherTools, NpyOfEveryTypeOrderAndShape) {
  const TemporaryFolder folder;
  const auto path = folder / "d.npy";
  const std::array<float, 6> values = {1, 2, 3.5F, 4, 5, kNan};
  const auto expect = [&](const std::string& file, double scale = 0) {
    put_text(path, file);
    EXPECT_EQ(expect_map(path, scale, values), "");
  };
  // Halves: sign, 5 bits of exponent (15 = 1), 10 of fraction.
  const std::array<std::uint16_t, 6> halves = {0x3C00, 0x4000, 0x4300, 0x4400, 0x4500, 0x7E00};
  expect(npy("<f2", bytes_of_values(halves)));
  const std::array<double, 6> doubles = {1, 2, 3.5, 4, 5, std::nan("")};
  expect(npy("<f8", bytes_of_values(doubles), "False", "2, 3, 1"));
  expect(npy("<f8", bytes_of_values(doubles), "False", "1, 1, 2, 3"));
  const std::array<double, 6> by_columns = {1, 4, 2, 5, 3.5, std::nan("")};
  expect(npy("<f8", bytes_of_values(by_columns), "True"));
  expect(npy("|u1", bytes_of_values(std::array<std::uint8_t, 6>{2, 4, 7, 8, 10, 0})), 2);
  expect(npy("<u2", bytes_of_values(std::array<std::uint16_t, 6>{256, 512, 896, 1024, 1280, 0})),
         256);
  expect(npy("<i8", bytes_of_values(std::array<std::int64_t, 6>{256, 512, 896, 1024, 1280, 0})),
         256);
}

TEST(MapsOfOtherTools, WhatOpenCvCouldNotMatchIsUnknown) {
  const TemporaryFolder folder;
  // Of StereoSGBM with minDisparity 0: sixteenths, and −16.
  const std::array<std::int16_t, 6> sixteenths = {-16, 40, 0, 81, -16, 1600};
  const std::array<float, 6> pixels = {kNan, 2.5F, 0, 5.0625F, kNan, 100};
  put_text(folder / "d.npy", npy("<i2", bytes_of_values(sixteenths)));
  EXPECT_THAT(expect_map(folder / "d.npy", 16, pixels),
              testing::AllOf(HasSubstr("-16 (minDisparity - 1"), HasSubstr("33.3 %")));
  cv::Mat signed_image(2, 3, CV_16SC1, const_cast<std::int16_t*>(sixteenths.data()));
  ASSERT_TRUE(cv::imwrite(folder / "d.tif", signed_image));
  EXPECT_THAT(expect_map(folder / "d.tif", 16, pixels), HasSubstr("unknown"));
  EXPECT_THAT(error_of([&] { read_disparity(folder / "d.tif"); }), HasSubstr("disparity-scale"));
  // As PNG, which has no sign: 65520.
  cv::Mat wrapped(2, 3, CV_16UC1, const_cast<std::int16_t*>(sixteenths.data()));
  ASSERT_TRUE(cv::imwrite(folder / "d.png", wrapped));
  EXPECT_THAT(expect_map(folder / "d.png", 16, pixels),
              testing::AllOf(HasSubstr("32768"), HasSubstr("unknown")));

  // minDisparity −4: −80 is unknown, −64 and −17 are known.
  const std::array<std::int16_t, 6> below = {-80, -64, -17, 8, 3, -80};
  put_text(folder / "d.npy", npy("<i2", bytes_of_values(below)));
  expect_map(folder / "d.npy", 16, {kNan, -4, -1.0625F, 0.5F, 0.1875F, kNan});
  // Whole pixels: −1 is unknown.
  put_text(folder / "d.npy",
           npy("<i4", bytes_of_values(std::array<std::int32_t, 6>{-1, 40, 0, 81, -1, 100})));
  expect_map(folder / "d.npy", 1, {kNan, 40, 0, 81, kNan, 100});
  // All values are whole pixels, none is −1: they are of another tool, and all are known.
  put_text(folder / "d.npy",
           npy("<i2", bytes_of_values(std::array<std::int16_t, 6>{-80, -64, -16, 16, 32, 48})));
  EXPECT_EQ(expect_map(folder / "d.npy", 16, {-5, -4, -1, 1, 2, 3}), "");
}

TEST(MapsOfOtherTools, LargeUnsignedValuesStayWhatTheyAre) {
  const TemporaryFolder folder;
  Image<std::uint16_t> image(300, 1);
  for (int x = 0; x < 300; ++x) {
    image.at(x, 0) = static_cast<std::uint16_t>(x == 0 ? 65520 : 2560);
  }
  write_photograph(folder / "d.png", Photograph{std::move(image)});
  std::vector<Remark> remarks;
  EXPECT_EQ(read_disparity(folder / "d.png", 0, &remarks).at(0, 0), 255.9375F);
  EXPECT_EQ(read_disparity(folder / "d.png", 256, &remarks).at(0, 0), 255.9375F);
  EXPECT_TRUE(remarks.empty());
  // No partner is 327 px away in 300 px: −0.08 px.
  EXPECT_EQ(read_disparity(folder / "d.png", 200, &remarks).at(0, 0), -0.08F);
  EXPECT_EQ(remarks.size(), 1U);
}

TEST(MapsOfOtherTools, DepthsHaveTheUnitOfTheirTypeOrAScale) {
  const TemporaryFolder folder;
  std::vector<Remark> remarks;
  put_text(folder / "z.npy",
           npy("<u2", bytes_of_values(std::array<std::uint16_t, 6>{1500, 0, 250, 250, 250, 9})));
  const Image<float> millimetres = read_depth(folder / "z.npy", 0, &remarks);
  EXPECT_EQ(millimetres.at(0, 0), 1.5F);
  EXPECT_TRUE(std::isnan(millimetres.at(1, 0)));
  EXPECT_EQ(read_depth(folder / "z.npy", 5000, &remarks).at(0, 0), 0.3F);
  put_text(folder / "z.npy",
           npy("<f4", bytes_of_values(std::array<float, 6>{1.5F, 0, -1, kNan, 2, 3})));
  const Image<float> metres = read_depth(folder / "z.npy", 0, &remarks);
  EXPECT_EQ(metres.at(0, 0), 1.5F);
  for (const auto& [x, y] : {std::pair{1, 0}, {2, 0}, {0, 1}}) {
    EXPECT_TRUE(std::isnan(metres.at(x, y)));
  }
  ASSERT_EQ(remarks.size(), 3U);
  EXPECT_THAT(remarks[0].text, HasSubstr("millimetres: median 0.25 m"));
  EXPECT_THAT(remarks[1].text, HasSubstr("5000 per metre"));
  EXPECT_THAT(remarks[2].text, HasSubstr("taken as metres: median 2 m"));
  EXPECT_THROW(read_depth(folder / "z.npy", -1), UsageError);
}

}  // namespace vantage::maps_of_other_tools_test
