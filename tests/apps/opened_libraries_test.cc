// Which shared libraries commands open: those that take long only where they are needed.

#include <set>
#include <sstream>

#include "tests/apps/pair_fixture.h"

namespace vantage::opened_libraries_test {

class OpenedLibraries : public PairTest {
 protected:
  /// Names of the files that the dynamic linker initialises while the program runs with these
  /// arguments, as it tells itself.
  [[nodiscard]] std::set<std::string> opened_by(const Words& arguments) const {
    const TemporaryFolder log;
    succeeds(run_vantage(arguments, {"LD_DEBUG=libs", "LD_DEBUG_OUTPUT=" + log / "linker"}));
    std::set<std::string> names;
    for (const fs::directory_entry& file : fs::directory_iterator(log.path())) {
      std::istringstream lines(read_file(file.path()));
      for (std::string line; std::getline(lines, line);) {
        const std::string what = "calling init: ";
        if (const std::size_t at = line.find(what); at != std::string::npos) {
          names.insert(fs::path(line.substr(at + what.size())).filename().string());
        }
      }
    }
    EXPECT_THAT(names, Contains(StartsWith("libopencv_core.so")));  // so it is told
    return names;
  }

  /// Success when `names` has none of those that take long.
  static void expect_only_quick_ones(const std::set<std::string>& names) {
    for (const char* slow :
         {"libavformat.so", "libavcodec.so", "libopencv_imgcodecs.so", "libgdal.so"}) {
      EXPECT_THAT(names, Each(Not(StartsWith(slow))));
    }
  }
};

TEST_F(OpenedLibraries, NoneThatTakeLongForTheVersion) {
  const std::set<std::string> names = opened_by({"--version"});
  expect_only_quick_ones(names);
  EXPECT_THAT(names, Each(Not(StartsWith("libopencv_video.so"))));
  EXPECT_THAT(names, Each(Not(StartsWith("libopencv_dnn.so"))));
}

TEST_F(OpenedLibraries, NoneThatTakeLongForWhatIsKnownOfTheMachine) {
  expect_only_quick_ones(opened_by({"info"}));
}

TEST_F(OpenedLibraries, NoneThatTakeLongForMapsOfUsualPng) {
  expect_only_quick_ones(
      opened_by({"match", left_, right_, "-o", folder_ / "map.pfm", "--disparities=0:9"}));
}

TEST_F(OpenedLibraries, NoneThatTakeLongForPngThatIsWritten) {
  expect_only_quick_ones(opened_by(
      {"synth", left_, right_, "--disparities=0:9", "--view=0.5", "-o", folder_ / "view.png"}));
}

TEST_F(OpenedLibraries, NoneThatTakeLongForMapsOfJpeg) {
  write_photograph(folder_ / "left.jpg", pair_.left);
  expect_only_quick_ones(opened_by(
      {"match", folder_ / "left.jpg", right_, "-o", folder_ / "map.pfm", "--disparities=0:9"}));
}

TEST_F(OpenedLibraries, ImageCodecsButNoVideoCodecsForWebp) {
  const std::string webp = folder_ / "left.webp";
  write_photograph(webp, pair_.left);
  const std::set<std::string> names =
      opened_by({"match", webp, right_, "-o", folder_ / "map.pfm", "--disparities=0:9"});
  EXPECT_THAT(names, Contains(StartsWith("libopencv_imgcodecs.so")));
  EXPECT_THAT(names, Each(Not(StartsWith("libavcodec.so"))));
}

TEST_F(OpenedLibraries, NoneOfOpenCvForTiffThatIsRead) {
  const std::string tiff = folder_ / "left.tiff";
  write_photograph(tiff, pair_.left);
  const std::set<std::string> names =
      opened_by({"match", tiff, right_, "-o", folder_ / "map.pfm", "--disparities=0:9"});
  EXPECT_THAT(names, Contains(StartsWith("libtiff.so")));
  EXPECT_THAT(names, Each(Not(StartsWith("libopencv_imgcodecs.so"))));
}

TEST_F(OpenedLibraries, VideoCodecsButNoImageCodecsForVideos) {
  const std::set<std::string> names = opened_by(
      {"synth", left_, right_, "--disparities=0:9", "--sweep=0:1:3", "-o", folder_ / "sweep.mp4"});
  EXPECT_THAT(names, Contains(StartsWith("libavcodec.so")));
  EXPECT_THAT(names, Each(Not(StartsWith("libopencv_imgcodecs.so"))));
}

}  // namespace vantage::opened_libraries_test
