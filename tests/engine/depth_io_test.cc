#include "engine/io/maps/map_io.h"

#include "engine/io/images/photograph_io.h"
#include "engine/io/maps/map_formats.h"
#include "tests/engine/engine_test.h"

namespace vantage::depth_io_test {

Image<float> some_depths() {
  Image<float> depths(3, 2);
  const float values[] = {1.2346F, 65.535F, 0.0001F, std::numeric_limits<float>::quiet_NaN(),
                          12,      3};
  std::copy(values, values + 3, depths.row(0));
  std::copy(values + 3, values + 6, depths.row(1));
  return depths;
}

TEST(DepthIo, PngHoldsMillimetres) {
  const TemporaryFolder folder;
  const std::string path = folder / "z.png";
  write_depth(path, some_depths().view());
  const Photograph read = read_photograph(path);
  const auto& image = std::get<Image<std::uint16_t>>(read.pixels);
  EXPECT_EQ(image.at(0, 0), 1235);
  EXPECT_EQ(image.at(1, 0), 65535);
  EXPECT_EQ(image.at(2, 0), 1);  // not unknown
  EXPECT_EQ(image.at(0, 1), 0);
  EXPECT_EQ(image.at(1, 1), 12000);
  Image<float> far(1, 1);
  far.at(0, 0) = 65.6F;
  EXPECT_NE(error_of([&] { write_depth(path, far.view()); }).find("expected at most 65.535"),
            std::string::npos);
  EXPECT_TRUE(same(read_photograph(path), read));  // as it was
}

TEST(DepthIo, OtherFormatsHoldMetres) {
  const TemporaryFolder folder;
  const Image<float> depths = some_depths();
  for (const MapFormat& format : map_formats()) {
    if (!format.can_hold(MapContent::kDepth) || format.extension == ".png") {
      continue;
    }
    const auto path = folder / ("z" + std::string(format.extension));
    write_depth(path, depths.view());
    const DisparityMap read = read_disparity(path);
    for (const auto [x, y] : positions_of(3, 2)) {
      EXPECT_TRUE(read.at(x, y) == depths.at(x, y) ||
                  (std::isnan(read.at(x, y)) && std::isnan(depths.at(x, y))))
          << format.extension;
    }
    EXPECT_EQ(largest_depth_m(path), std::numeric_limits<double>::infinity());
  }
  EXPECT_EQ(largest_depth_m("a.PNG"), 65.535);
}

TEST(DepthIo, SaysWhatIsWrong) {
  EXPECT_EQ(error_of([] { write_depth("z.flo", some_depths().view()); }),
            "cannot write z.flo: unknown depth extension '.flo', expected .pfm, .png, .tiff, .exr "
            "or .npy");
  EXPECT_NE(error_of([] { write_depth("z.npy", Image<float>(0, 0).view()); }), "");
}

}  // namespace vantage::depth_io_test
