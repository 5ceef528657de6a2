// New views of photographs that are not rectified: colours come from the photographs themselves.

#include <array>

#include "engine/rectification/rectifier.h"
#include "tests/apps/run_fixture.h"

namespace vantage::unrectified_views_test {

class UnrectifiedViews : public RunTest {
 protected:
  void SetUp() override {
    write_file(rig_, kTurnedRig);
    DisparityMap map(kWidth, kHeight);
    map.fill(3);  // so that half-way between the cameras is between pixels
    write_disparity(map_, map.view());
    const Rectifier rectifier(read_stereo_calibration(rig_), kWidth, kHeight);
    Execution execution(ExecutionOptions{});
    for (const Side side : {Side::kLeft, Side::kRight}) {
      const std::size_t index = index_of(side);
      rectifier.apply(read_photograph(photographs_[index]), side, rectified_[index], execution);
      write_photograph(rectified_files_[index], rectified_[index]);
    }
  }

  /// The view that `synth` makes of `images` and maps of disparity 3.
  [[nodiscard]] Photograph synth(const std::array<std::string, 2>& images,
                                 const Words& more) const {
    const std::string out = folder_ / "view.png";
    succeeds(run_vantage(joined({"synth", images[0], images[1], "-o", out, "--left-disparity", map_,
                                 "--right-disparity", map_, "--quiet"},
                                more)));
    return read_photograph(out);
  }

  static double largest_difference(const Photograph& a, const Photograph& b) {
    double largest = 0;
    for_each_value(a, [&](int x, int y, double value) {
      largest = std::max(largest, std::abs(value - value_at(b, x, y)));
    });
    return largest;
  }

  /// Between neighbours in rows: less of it has been blurred.
  static double mean_contrast(const Photograph& picture) {
    double sum = 0;
    for_each_value(picture, [&](int x, int y, double value) {
      const int channels = picture.channels();
      sum += x >= channels ? std::abs(value - value_at(picture, x - channels, y)) : 0;
    });
    return sum / (picture.width() * picture.height() * picture.channels());
  }

  std::string rig_ = folder_ / "rig.yml";
  std::string map_ = folder_ / "map.pfm";
  std::array<std::string, 2> photographs_{left_ + "/" + frame_file(0),
                                          right_ + "/" + frame_file(0)};
  std::array<Photograph, 2> rectified_;
  std::array<std::string, 2> rectified_files_{folder_ / "left.png", folder_ / "right.png"};

 private:
  static double value_at(const Photograph& picture, int x, int y) {
    return std::get<Image<std::uint8_t>>(picture.pixels).row(y)[x];
  }
  /// Calls body(index in the row, y, value).
  template <typename Body>
  static void for_each_value(const Photograph& picture, const Body& body) {
    for (int y = 0; y < picture.height(); ++y) {
      for (int x = 0; x < picture.width() * picture.channels(); ++x) {
        body(x, y, value_at(picture, x, y));
      }
    }
  }
};

TEST_F(UnrectifiedViews, AtTheLeftCameraAreTheRectifiedPhotograph) {
  const Photograph once =
      synth(photographs_, {"--calibration", rig_, "--view", "0", "--gamma", "1"});
  EXPECT_LE(largest_difference(once, rectified_[0]), 1);
  const Photograph book = synth(
      photographs_, {"--calibration", rig_, "--view", "0", "--gamma", "1", "--warp", "forward"});
  EXPECT_EQ(largest_difference(book, rectified_[0]), 0);
}

TEST_F(UnrectifiedViews, AreSharperThanThoseOfRectifiedFiles) {
  for (const std::string place : {"0.5", "0.5,0.5"}) {
    const Words more = {"--view", place};
    const Photograph once = synth(photographs_, joined(more, {"--calibration", rig_}));
    const Photograph twice = synth(rectified_files_, more);
    EXPECT_GT(mean_contrast(once), 1.02 * mean_contrast(twice)) << "at " << place;
    // The book's method moves what has been rectified.
    const Words forward = joined(more, {"--warp", "forward"});
    EXPECT_EQ(largest_difference(synth(photographs_, joined(forward, {"--calibration", rig_})),
                                 synth(rectified_files_, forward)),
              0);
  }
}

TEST_F(UnrectifiedViews, OfARunAreThoseOfSynth) {
  for (const std::string place : {"0.5", "0.4,0.3"}) {
    const Words more = {"--method", "ssd", "--calibration", rig_, "--view", place, "--quiet"};
    const std::string out = folder_ / ("run-" + place);
    succeeds(run(out, joined(more, {"--save", "views", "--frames", "0-1"})));
    FolderContent views = results_in(out);
    ASSERT_EQ(views.size(), 2U);
    for (const int frame : {0, 1}) {
      const std::string file = folder_ / "view.png";
      succeeds(
          run_vantage(joined({"synth", left_ + "/" + frame_file(frame),
                              right_ + "/" + frame_file(frame), "-o", file, "--disparities=0:9"},
                             more)));
      const auto made_by_run = std::next(views.begin(), frame);
      EXPECT_EQ(read_file(file), made_by_run->second) << made_by_run->first << " at " << place;
    }
  }
}

// Frames of a movie share one brightness and one set of maps with their colours.
TEST_F(UnrectifiedViews, OfAMovieAreThoseOfSingleViews) {
  const std::string pattern = folder_ / "movie%d.png";
  const ProcessResult movie = succeeds(
      run_vantage({"synth", photographs_[0], photographs_[1], "-o", pattern, "--left-disparity",
                   map_, "--right-disparity", map_, "--calibration", rig_, "--view", "0.5",
                   "--view", "0.25,0.5", "--quiet", "--no-intensity-matching"}));
  const std::string places[] = {"0.5", "0.25,0.5"};
  for (int view = 0; view < 2; ++view) {
    const Photograph alone = synth(
        photographs_, {"--calibration", rig_, "--view", places[view], "--no-intensity-matching"});
    EXPECT_EQ(largest_difference(
                  alone, read_photograph(folder_ / ("movie" + std::to_string(view) + ".png"))),
              0);
  }
}

}  // namespace vantage::unrectified_views_test
