

#include <opencv2/imgcodecs.hpp>

#include "engine/io/images/photograph_io.h"
#include "engine/io/maps/map_io.h"
#include "engine/io/video/frame_source.h"
#include "engine/io/video/video_io.h"
#include "tests/engine/engine_test.h"
#include "tests/test_sample.h"

namespace vantage::malformed_input_test {

/// Calls `read` with the file cut at every place and with bytes changed at random. It must return
/// or throw an Error of one line that names the file; anything else ends the test, or the process.
void read_damaged(const std::filesystem::path& path, int flips,
                  const std::function<void(const std::filesystem::path&)>& read) {
  const std::vector<std::uint8_t> whole = bytes_of(path);
  const auto attempt = [&](const std::vector<std::uint8_t>& bytes, const std::string& what) {
    put_bytes(path, bytes);
    try {
      read(path);
    } catch (const Error& error) {
      const std::string text = error.what();
      EXPECT_NE(text.find(path.filename().string()), std::string::npos) << what << ": " << text;
      EXPECT_EQ(text.find('\n'), std::string::npos) << what << ": " << text;
    }
  };
  const std::size_t step = std::max<std::size_t>(1, whole.size() / 60);
  for (std::size_t size = 0; size < whole.size(); size += size < 40 ? 1 : step) {
    attempt({whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)},
            "cut at " + std::to_string(size));
  }
  std::mt19937 generator(6 + sample_seed());
  for (int i = 0; i < (runs_everything() ? 4 * flips : flips); ++i) {
    std::vector<std::uint8_t> bytes = whole;
    // Headers decide most, so every second change is near the front.
    const std::size_t range = i % 2 == 0 ? bytes.size() : std::min<std::size_t>(bytes.size(), 64);
    for (unsigned change = 0; change <= generator() % 3; ++change) {
      bytes[generator() % range] = static_cast<std::uint8_t>(generator());
    }
    attempt(bytes, "change " + std::to_string(i));
  }
  put_bytes(path, whole);
  EXPECT_NO_THROW(read(path));
}

/// Touches every value, so that a sanitizer sees one that is not there.
void expect_valid(const Photograph& photograph) {
  ASSERT_GE(photograph.width(), 1);
  ASSERT_GE(photograph.height(), 1);
  const int channels = photograph.channels();
  ASSERT_TRUE(channels == 1 || channels == 3 || channels == 4) << channels;
  std::visit(
      [&](const auto& image) {
        for (const auto [i, y] : positions_of(image.width() * channels, image.height())) {
          ASSERT_TRUE(std::isfinite(static_cast<float>(image.row(y)[i])));
        }
      },
      photograph.pixels);
}

class MalformedImage : public testing::TestWithParam<const char*> {};

TEST_P(MalformedImage, IsAnErrorOrAnImage) {
  const TemporaryFolder folder;
  const std::string extension = GetParam();
  const auto path = folder / ("image" + extension);
  if (extension == ".pfm" || extension == ".exr") {
    write_photograph(path, noise<float>(13, 7, 3));
  } else if (extension == ".pgm") {
    write_photograph(path, noise<std::uint16_t>(13, 7, 1));
  } else if (extension == ".jp2") {
    cv::imwrite(path, cv::Mat(40, 70, CV_8UC3, cv::Scalar(10, 90, 200)));
  } else {
    write_photograph(path, noise<std::uint8_t>(13, 7, 3));
  }
  read_damaged(path, 90, [](const auto& file) { expect_valid(read_photograph(file)); });
}

INSTANTIATE_TEST_SUITE_P(Formats, MalformedImage,
                         testing::Values(".png", ".jpg", ".tiff", ".bmp", ".ppm", ".pgm", ".webp",
                                         ".exr", ".pfm", ".jp2"),
                         [](const auto& test) { return std::string(test.param).substr(1); });

class MalformedDisparity : public testing::TestWithParam<const char*> {};

TEST_P(MalformedDisparity, IsAnErrorOrAMap) {
  const TemporaryFolder folder;
  DisparityMap map(9, 5);
  map.fill(3.25F);
  map.at(4, 2) = NAN;
  const auto path = folder / (std::string("map") + GetParam());
  write_disparity(path, map.view());
  read_damaged(path, 90, [](const auto& file) {
    const DisparityMap read = read_disparity(file);
    for (const auto [x, y] : positions_of(read)) {
      ASSERT_FALSE(std::isinf(read.at(x, y)));
    }
  });
}

INSTANTIATE_TEST_SUITE_P(Formats, MalformedDisparity,
                         testing::Values(".pfm", ".png", ".tiff", ".exr", ".npy"),
                         [](const auto& test) { return std::string(test.param).substr(1); });

TEST(MalformedVideo, IsAnErrorOrFrames) {
  const TemporaryFolder folder;
  const auto path = folder / "video.mp4";
  VideoWriter writer(path, 32, 32, {});
  for (unsigned i = 0; i < 4; ++i) {
    writer.write(noise<std::uint8_t>(32, 32, 3, i));
  }
  writer.finish();
  read_damaged(path, 60, [](const auto& file) {
    const auto source = open_frame_source(file.string());
    Photograph frame;
    for (int i = 0; i < 20 && source->next(frame); ++i) {
      expect_valid(frame);
    }
  });
}

/// Text images have no bytes to change in their headers that the binary ones have not; but their
/// data is parsed.
TEST(MalformedText, IsAnErrorOrAnImage) {
  const TemporaryFolder folder;
  for (const char* text : {"P1\n3 2\n0 1 0\n1 1 0\n", "P2\n3 2\n15\n0 1 15\n3 4 5\n",
                           "P3\n1 2\n255\n0 1 255\n3 4 5\n"}) {
    put_text(folder / "text.pnm", text);
    read_damaged(folder / "text.pnm", 60,
                 [](const auto& file) { expect_valid(read_photograph(file)); });
  }
}

}  // namespace vantage::malformed_input_test
