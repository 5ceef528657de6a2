#include "engine/io/maps/map_io.h"

#include "engine/io/images/photograph_io.h"
#include "tests/engine/engine_test.h"
#include "tests/test_paths.h"

namespace vantage::disparity_io_test {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

bool same_or_both_unknown(float a, float b) { return a == b || (std::isnan(a) && std::isnan(b)); }

/// Disparities on a grid of 1/256, of both signs when `low` is negative, one in five unknown.
DisparityMap random_map(int width, int height, int low, unsigned seed = 3) {
  std::mt19937 generator(seed);
  DisparityMap map(width, height);
  for (const auto [x, y] : positions_of(width, height)) {
    const float d = static_cast<float>(generator() % 20000 + 1) / 256.0F + static_cast<float>(low);
    map.at(x, y) = generator() % 5 == 0 ? kNan : d;
  }
  return map;
}

std::string little_endian(float value) {
  std::string text(4, '\0');
  std::memcpy(text.data(), &value, 4);
  return text;
}

std::string big_endian(float value) {
  std::string text = little_endian(value);
  return {text.rbegin(), text.rend()};
}

TEST(DisparityIo, EveryFormatReturnsWhatWasWritten) {
  const TemporaryFolder folder;
  for (const char* name : {"d.pfm", "d.png", "d.tiff", "d.TIF", "d.exr", "d.npy"}) {
    for (const auto& [width, height] :
         {std::pair{1, 1}, std::pair{1, 5}, std::pair{7, 1}, std::pair{13, 11}, std::pair{67, 3}}) {
      const DisparityMap map = random_map(width, height, std::string(name) == "d.png" ? 0 : -30);
      write_disparity(folder / name, map.view());
      const DisparityMap read = read_disparity(folder / name);
      ASSERT_EQ(read.width(), width);
      ASSERT_EQ(read.height(), height);
      for (const auto [x, y] : positions_of(width, height)) {
        EXPECT_TRUE(same_or_both_unknown(read.at(x, y), map.at(x, y)))
            << name << " " << x << "," << y << ": " << read.at(x, y) << " " << map.at(x, y);
      }
    }
  }
  EXPECT_EQ(folder.entries(), 6U);
}

TEST(DisparityIo, InfinityIsUnknownInEveryFormat) {
  const TemporaryFolder folder;
  DisparityMap map(2, 1);
  map.at(0, 0) = 3;
  for (const float unknown : {kInfinity, -kInfinity, kNan}) {
    map.at(1, 0) = unknown;
    for (const char* name : {"d.pfm", "d.png", "d.tiff", "d.exr", "d.npy"}) {
      write_disparity(folder / name, map.view());
      const DisparityMap read = read_disparity(folder / name);
      EXPECT_EQ(read.at(0, 0), 3) << name;
      EXPECT_TRUE(std::isnan(read.at(1, 0))) << name;
    }
  }
}

TEST(DisparityIo, PfmBytesAreLittleEndianBottomUpWithInfinity) {
  const TemporaryFolder folder;
  DisparityMap map(2, 2);
  map.at(0, 0) = 1;
  map.at(1, 0) = kNan;
  map.at(0, 1) = 3.5F;
  map.at(1, 1) = -4;
  write_disparity(folder / "d.pfm", map.view());
  const std::string expected = "Pf\n2 2\n-1.0\n" + little_endian(3.5F) + little_endian(-4) +
                               little_endian(1) + little_endian(kInfinity);
  const auto bytes = bytes_of(folder / "d.pfm");
  EXPECT_EQ(std::string(bytes.begin(), bytes.end()), expected);
}

TEST(DisparityIo, ReadsPfmOfOtherWriters) {
  const TemporaryFolder folder;
  const auto expect = [&](const std::string& text) {
    put_text(folder / "d.pfm", text);
    const DisparityMap map = read_disparity(folder / "d.pfm");
    EXPECT_EQ(map.at(0, 0), 2.5F);
    EXPECT_TRUE(std::isnan(map.at(1, 0)));
  };
  const std::string little = little_endian(2.5F) + little_endian(kInfinity);
  expect("Pf\n2 1\n-1\n" + little);
  expect("Pf\n2 1\n1.0\n" + big_endian(2.5F) + big_endian(kInfinity));
  expect("Pf \n2 1 \n-1.0\n" + little);
  expect("Pf\r\n2 1\r\n-0.0039\r\n" + little);
  expect("Pf 2 1 -1 " + little);
  expect("Pf\n2\n1\n-1e0 \n" + little);
  expect("Pf # of a camera\n# 2014\n2 1\n#-\n-1\n" + little);
  // A first data byte that happens to be a line end belongs to the data.
  const float tricky = std::bit_cast<float>(0x4220000AU);
  put_text(folder / "d.pfm", "Pf\n1 1\n-1 " + little_endian(tricky));
  EXPECT_EQ(read_disparity(folder / "d.pfm").at(0, 0), tricky);
}

TEST(DisparityIo, IntegerFilesAreDividedByTheirScale) {
  const TemporaryFolder folder;
  put_text(folder / "d.pgm", std::string("P5\n3 1\n255\n\x00\x04\x0A", 14));
  EXPECT_THAT(error_of([&] { read_disparity(folder / "d.pgm"); }), HasSubstr("scale"));
  const DisparityMap map = read_disparity(folder / "d.pgm", 4);
  EXPECT_TRUE(std::isnan(map.at(0, 0)));
  EXPECT_EQ(map.at(1, 0), 1);
  EXPECT_EQ(map.at(2, 0), 2.5F);

  // The largest value of the header says nothing about disparities.
  put_text(folder / "d.pgm", "P2\n1 1\n16\n8\n");
  EXPECT_EQ(read_disparity(folder / "d.pgm", 4).at(0, 0), 2);

  Image<std::uint16_t> image(2, 1);
  image.at(0, 0) = 0;
  image.at(1, 0) = 640;
  write_photograph(folder / "d.png", Photograph{std::move(image)});
  EXPECT_EQ(read_disparity(folder / "d.png").at(1, 0), 2.5F);
  EXPECT_EQ(read_disparity(folder / "d.png", 64).at(1, 0), 10);
  EXPECT_TRUE(std::isnan(read_disparity(folder / "d.png").at(0, 0)));

  EXPECT_THROW(read_disparity(folder / "d.png", -1), UsageError);
  EXPECT_THROW(read_disparity(folder / "d.png", kNan), UsageError);
}

TEST(DisparityIo, PngKeepsZeroKnownAndRefusesWhatDoesNotFit) {
  const TemporaryFolder folder;
  DisparityMap map(2, 1);
  map.at(1, 0) = 255.99F;
  for (const float small : {0.0F, -0.0F, 1e-30F, 0.9F / 512, 1.0F / 512, -0.9F / 512}) {
    map.at(0, 0) = small;
    write_disparity(folder / "d.png", map.view());
    EXPECT_EQ(read_disparity(folder / "d.png").at(0, 0), 1 / 256.0F) << small;
  }
  for (const float bad : {-0.5F, -1.1F / 512, 256.0F, 1e30F}) {
    map.at(1, 0) = bad;
    EXPECT_THAT(error_of([&] { write_disparity(folder / "e.png", map.view()); }),
                HasSubstr("pixel (1, 0)"));
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "e.png"));
}

TEST(DisparityIo, SaysBeforeASearchWhichFilesHoldIt) {
  for (const char* name : {"d.pfm", "d.tiff", "d.exr", "d.npy", "d.PNG"}) {
    EXPECT_NO_THROW(require_holds_search(name, 0, 255)) << name;
  }
  EXPECT_NO_THROW(require_holds_search("d.pfm", -3, 300));
  for (const auto& [min, max] : {std::pair{-1, 63}, {-90, -10}, {0, 256}}) {
    EXPECT_THROW(require_holds_search("d.png", min, max), UsageError);
  }
  EXPECT_THAT(error_of([&] { require_holds_search("maps/d.PNG", -3, 60); }),
              testing::AllOf(HasSubstr("maps/d.PNG"), HasSubstr("-3:60"), HasSubstr(".pfm")));
}

std::string npy(const std::string& dictionary, const std::string& data, char version = 1) {
  std::string header = dictionary + "\n";
  std::string text = std::string("\x93NUMPY") + version + '\0';
  text += static_cast<char>(header.size());
  text += '\0';
  if (version > 1) {
    text += std::string(2, '\0');
  }
  return text + header + data;
}

TEST(DisparityIo, ReadsNpyOfEveryVersionAndBothFloats) {
  const TemporaryFolder folder;
  const double wide[2] = {2.5, std::numeric_limits<double>::quiet_NaN()};
  const std::string doubles(reinterpret_cast<const char*>(wide), sizeof(wide));
  const std::string floats = little_endian(2.5F) + little_endian(kNan);
  for (const char version : {'\1', '\2', '\3'}) {
    for (const std::string& text :
         {npy("{'descr': '<f4', 'fortran_order': False, 'shape': (1, 2), }", floats, version),
          npy("{\"shape\": (1,2), 'fortran_order':False,'descr':'<f8'}", doubles, version)}) {
      put_text(folder / "d.npy", text);
      const DisparityMap map = read_disparity(folder / "d.npy");
      ASSERT_EQ(map.width(), 2);
      ASSERT_EQ(map.height(), 1);
      EXPECT_EQ(map.at(0, 0), 2.5F);
      EXPECT_TRUE(std::isnan(map.at(1, 0)));
    }
  }
}

TEST(DisparityIo, RefusesOtherNpyAndSaysWhy) {
  const TemporaryFolder folder;
  const auto refuse = [&](const std::string& text, const char* expected) {
    put_text(folder / "d.npy", text);
    EXPECT_THAT(error_of([&] { read_disparity(folder / "d.npy"); }), HasSubstr(expected));
  };
  const std::string data(8, '\0');
  refuse(npy("{'descr': '>f4', 'fortran_order': False, 'shape': (1, 2), }", data), ">f4");
  refuse(npy("{'descr': '<c8', 'fortran_order': False, 'shape': (1, 1), }", data), "<c8");
  refuse(npy("{'descr': '|b1', 'fortran_order': False, 'shape': (1, 2), }", data), "|b1");
  refuse(npy("{'descr': '<i4', 'fortran_order': False, 'shape': (1, 2), }", data),
         "16 for maps of OpenCV's matchers");
  refuse(npy("{'descr': '<f4', 'fortran_order': False, 'shape': (2,), }", data), "shape (2,)");
  refuse(npy("{'descr': '<f4', 'fortran_order': False, 'shape': (2, 1, 2), }", data), "shape");
  refuse(npy("{'descr': '<f4', 'fortran_order': False, 'shape': (0, 2), }", data), "2x0");
  refuse(npy("{'descr': '<f4', 'fortran_order': False, 'shape': (99999, 99999), }", data),
         "at most");
  refuse(npy("{'descr': '<f4', 'fortran_order': False, 'shape': (2, 2), }", data), "truncated");
  refuse(npy("{'descr': '<f4', 'shape': (1, 2), }", data), "fortran_order");
  refuse(npy("{'descr': '<f4', 'fortran_order': False, 'shape': (1, 2), }", data, 4), "version 4");
  refuse("\x93NUMPY", "truncated");
}

TEST(DisparityIo, RefusesColourUnknownExtensionsAndEmptyMaps) {
  const TemporaryFolder folder;
  write_photograph(folder / "c.png", noise<std::uint16_t>(3, 3, 3));
  EXPECT_THAT(error_of([&] { read_disparity(folder / "c.png"); }), HasSubstr("3 channels"));
  const DisparityMap map = random_map(2, 2, 0);
  for (const char* name : {"d.jpg", "d.pgm", "d"}) {
    EXPECT_THROW(write_disparity(folder / name, map.view()), UsageError);
  }
  EXPECT_THROW(write_disparity(folder / "d.pfm", {}), Error);
  EXPECT_EQ(folder.entries(), 1U);
}

TEST(DisparityIo, ReadsAllSharedTruths) {
  const std::filesystem::path data = test_paths::shared_data();
  if (!std::filesystem::is_directory(data)) {
    GTEST_SKIP() << "no disparity maps at " << data;
  }
  struct Truth {
    const char* file;
    double scale;
    float min, max;
    double known_percent;
  };
  // Ranges and coverage as the data's own documentation gives them.
  for (const Truth& truth :
       {Truth{"tsukuba/disp3.pgm", 16, 5, 14, 79.3}, Truth{"venus/disp2.pgm", 8, 3, 19.75F, 100},
        Truth{"cones/disp2.png", 4, 5.5F, 55, 96.8},
        Truth{"aloe/disp1.png", 2, 21.5F, 105.5F, 96.9},
        Truth{"motorcycle/disp0.pfm", 0, 9.18F, 62.88F, 97.9},
        Truth{"kitti2015_000045/disp_noc_0.png", 0, 4.88F, 89.36F, 14.8},
        Truth{"antinous/disp4.pfm", 0, -3.13F, 2.69F, 100},
        Truth{"flyingthings_a0032/disp_left.pfm", 0, 1.21F, 130.36F, 100},
        Truth{"motorcycle_perfect/disp0.pfm", 0, 7.19F, 59.91F, 92.7}}) {
    const DisparityMap map = read_disparity(data / truth.file, truth.scale);
    float low = kInfinity;
    float high = -kInfinity;
    int known = 0;
    for (const auto [x, y] : positions_of(map)) {
      if (std::isfinite(map.at(x, y))) {
        low = std::min(low, map.at(x, y));
        high = std::max(high, map.at(x, y));
        ++known;
      }
    }
    EXPECT_NEAR(low, truth.min, 0.006) << truth.file;
    EXPECT_NEAR(high, truth.max, 0.006) << truth.file;
    EXPECT_NEAR(100.0 * known / (map.width() * map.height()), truth.known_percent, 0.06)
        << truth.file;
  }
}

}  // namespace vantage::disparity_io_test
