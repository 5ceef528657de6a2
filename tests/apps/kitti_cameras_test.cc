// Which of KITTI's four cameras a calibration is taken for.

#include "tests/apps/pair_fixture.h"

namespace vantage::kitti_cameras_test {

constexpr const char* kGreyLines =
    "P0: 70 0 35 0 0 70 26 0 0 0 1 0\n"
    "P1: 70 0 35 -35 0 70 26 0 0 0 1 0\n";
constexpr const char* kColourLines =
    "P2: 70 0 35 7 0 70 26 0 0 0 1 0\n"
    "P3: 70 0 35 -35 0 70 26 0 0 0 1 0\n";

/// A file of both pairs, of baselines 0.5 m and 0.6 m, and the images in several folders.
class KittiCameras : public PairTest {
 protected:
  KittiCameras() {
    write_file(file_, std::string(kGreyLines) + kColourLines);
    for (const auto& [left, right] :
         {std::pair{"image_0", "image_1"}, {"image_2", "image_3"}, {"left", "right"}}) {
      copy(left_, left);
      copy(right_, right);
    }
  }

  void copy(const std::string& image, const std::string& folder) const {
    fs::create_directory(folder_ / folder);
    fs::copy_file(image, folder_ / folder + "/000000.png");
  }

  /// Baseline that 'match' uses for images in two folders; its messages go to `err`.
  [[nodiscard]] double baseline(const std::string& left, const std::string& right,
                                const Words& more, std::string& err) const {
    const std::string report = folder_ / "report.json";
    const ProcessResult result = succeeds(run_vantage(joined(
        {"match", folder_ / left + "/000000.png", folder_ / right + "/000000.png", "-o",
         folder_ / "map.pfm", "--disparities=1:9", "--no-rectification-check", "--calibration",
         file_, "--depth-resolution", folder_ / "resolution.npy", "--report", report},
        more)));
    err = result.err;
    return read_json(report)["results"]["depth_resolution"]["baseline"];
  }

  std::string file_ = folder_ / "calib.txt";
};

TEST_F(KittiCameras, FollowFromTheFoldersOrTheOption) {
  std::string err;
  EXPECT_NEAR(baseline("image_2", "image_3", {}, err), 0.6, 1e-9);
  EXPECT_THAT(err, HasSubstr("match: --kitti-cameras auto is 2,3\n"));
  EXPECT_NEAR(baseline("image_0", "image_1", {}, err), 0.5, 1e-9);
  EXPECT_THAT(err, HasSubstr("match: --kitti-cameras auto is 0,1\n"));
  EXPECT_NEAR(baseline("image_0", "image_1", {"--kitti-cameras", "2,3"}, err), 0.6, 1e-9);
  EXPECT_THAT(err, Not(HasSubstr("kitti")));
  EXPECT_NEAR(baseline("left", "right", {}, err), 0.5, 1e-9);
  EXPECT_THAT(err, HasSubstr("calib.txt: has KITTI's cameras 0 to 3, and 0 and 1 (grey) are used; "
                             "--kitti-cameras 2,3 for images of 2 and 3 (colour)\n"));

  write_file(file_, kGreyLines);
  EXPECT_NEAR(baseline("image_2", "image_3", {}, err), 0.5, 1e-9);
  EXPECT_THAT(err, HasSubstr("has only KITTI's cameras 0 and 1, but the folders of the images are "
                             "those of 2 and 3\n"));
}

TEST_F(KittiCameras, AreTheSameInAllCommands) {
  std::string err;
  EXPECT_NEAR(baseline("image_2", "image_3", {}, err), 0.6, 1e-9);
  const std::string image = folder_ / "image_2/000000.png";
  const auto reproject = [&](const Words& more) {
    return run_vantage(joined({"reproject", folder_ / "map.pfm", "--calibration", file_, "--depth",
                               folder_ / "z.npy"},
                              more))
        .err;
  };
  EXPECT_THAT(reproject({"--image", image, "--cloud", folder_ / "cloud.ply"}),
              HasSubstr("baseline 0.6 m"));
  EXPECT_THAT(reproject({"--kitti-cameras", "2,3"}), HasSubstr("baseline 0.6 m"));
  EXPECT_THAT(reproject({}), HasSubstr("0 and 1 (grey) are used"));

  const ProcessResult rectified =
      run_vantage({"rectify", folder_ / "image_2", folder_ / "image_3", "--calibration", file_,
                   "-o", folder_ / "rectified"});
  EXPECT_THAT(rectified.err, HasSubstr("calib.txt (KITTI, cameras 2 and 3)"));
  const ProcessResult view =
      run_vantage({"synth", image, folder_ / "image_3/000000.png", "-o", folder_ / "view.png",
                   "--calibration", file_, "--disparities=1:9", "--view", "0.5"});
  EXPECT_THAT(view.err, HasSubstr("synth: --kitti-cameras auto is 2,3\n"));

  const std::string out = folder_ / "run";
  const Words run = {"run",
                     "--left",
                     folder_ / "image_2",
                     "--right",
                     folder_ / "image_3",
                     "--calibration",
                     file_,
                     "--save",
                     "disparity,depth",
                     "--depth-format",
                     "npy",
                     "-o",
                     out,
                     "--disparities",
                     "1:9"};
  const ProcessResult ran = run_vantage(run);
  EXPECT_THAT(ran.err, HasSubstr("run: --kitti-cameras auto is 2,3\n"));
  const DisparityMap disparities = read_disparity(out + "/disparity/000000.pfm");
  const DisparityMap depths = read_disparity(out + "/depth/000000.npy");
  EXPECT_NEAR(depths.at(35, 26), 0.6 * 70 / disparities.at(35, 26), 1e-4);

  EXPECT_THAT(run_vantage(joined(run, {"--resume", "--kitti-cameras", "0,1"})).err,
              HasSubstr("kitti-cameras"));
}

TEST_F(KittiCameras, ErrorsNameTheOption) {
  expect_failure(match(folder_ / "map.pfm", {"--kitti-cameras", "2,3"}), 2,
                 "--kitti-cameras has no effect without --calibration");
  write_file(file_, kGreyLines);
  expect_failure(match(folder_ / "map.pfm", {"--kitti-cameras", "2,3", "--calibration", file_}), 1,
                 "calib.txt: there is no P2 in it");
  write_file(file_,
             "cam0=[70 0 35; 0 70 26; 0 0 1]\ncam1=[70 0 35; 0 70 26; 0 0 1]\n"
             "doffs=0\nbaseline=100\nwidth=71\nheight=53\n");
  expect_failure(match(folder_ / "map.pfm", {"--kitti-cameras", "2,3", "--calibration", file_}), 1,
                 "calib.txt: has format Middlebury, expected KITTI");
}

}  // namespace vantage::kitti_cameras_test
