// Hand-held photographs without poses: `scene poses`, and what `scene build` makes of its model.

#include <sstream>

#include "tests/apps/posed_cameras.h"

namespace vantage::estimated_scene_test {

struct ModelImage {
  Eigen::Matrix3d rotation;
  Eigen::Vector3d translation;
  std::map<int, Eigen::Vector2d> seen;  // by number of the point, in COLMAP's pixels
};

/// A plain reader of images.txt.
std::map<std::string, ModelImage> model_images(const std::string& folder) {
  std::istringstream lines(read_file(folder + "/images.txt"));
  std::map<std::string, ModelImage> images;
  std::string line;
  while (std::getline(lines, line)) {
    if (line.starts_with("#")) {
      continue;
    }
    std::istringstream pose(line);
    double id = 0;
    double w = 0;
    double x = 0;
    double y = 0;
    double z = 0;
    double camera = 0;
    std::string name;
    ModelImage image;
    pose >> id >> w >> x >> y >> z >> image.translation.x() >> image.translation.y() >>
        image.translation.z() >> camera >> name;
    image.rotation = Eigen::Quaterniond(w, x, y, z).toRotationMatrix();
    std::getline(lines, line);
    std::istringstream points(line);
    double u = 0;
    double v = 0;
    int point = 0;
    while (points >> u >> v >> point) {
      image.seen[point] = {u, v};
    }
    images[name] = image;
  }
  return images;
}

class EstimatedScene : public PosedCameras {
 protected:
  EstimatedScene() : PosedCameras(240, 180) { write_lens(lens_); }

  [[nodiscard]] ProcessResult poses(const Words& more) const {
    return run_vantage(joined({"scene", "poses", "--images", images_, "-o", model_}, more));
  }

  std::string lens_ = folder_ / "lens.txt";
};

TEST_F(EstimatedScene, PosesLeadToViewsAndClouds) {
  const double metres = (cameras_[3].centre() - cameras_[0].centre()).norm();
  const ProcessResult found =
      succeeds(poses({"--intrinsics", lens_, "--known-distance", fmt::format("0:3:{}", metres),
                      "--report", folder_ / "poses.json"}));
  EXPECT_THAT(found.err, HasSubstr("4 of 4 images"));
  const auto images = model_images(model_);
  ASSERT_EQ(images.size(), 4U);
  const Eigen::Matrix3d first_turn = cameras_[0].rotation;
  for (std::size_t i = 0; i < 4; ++i) {
    const ModelImage& image = images.at(fmt::format("{}.png", i));
    const Eigen::Matrix3d truth = cameras_[i].rotation * first_turn.transpose();
    EXPECT_LT(Eigen::AngleAxisd(Eigen::Matrix3d(truth * image.rotation.transpose())).angle(), 0.01);
    const Eigen::Vector3d centre = first_turn * (cameras_[i].centre() - cameras_[0].centre());
    EXPECT_LT((-image.rotation.transpose() * image.translation - centre).norm(), 0.05 * metres);
  }
  // Points are where their images show them.
  std::istringstream lines(read_file(model_ + "/points3D.txt"));
  std::string line;
  std::getline(lines, line);
  double sum = 0;
  int sightings = 0;
  while (std::getline(lines, line)) {
    std::istringstream point(line);
    int number = 0;
    Eigen::Vector3d at;
    point >> number >> at.x() >> at.y() >> at.z();
    for (const auto& [name, image] : images) {
      if (image.seen.contains(number)) {
        const Eigen::Vector3d seen = cameras_[0].matrix * (image.rotation * at + image.translation);
        sum += (seen.hnormalized() + Eigen::Vector2d(0.5, 0.5) - image.seen.at(number)).norm();
        ++sightings;
      }
    }
  }
  EXPECT_GT(sightings, 300);
  EXPECT_LT(sum / sightings, 0.5);
  const auto results = read_json(folder_ / "poses.json").at("results");
  EXPECT_EQ(results.at("unit"), "metre");
  EXPECT_EQ(results.at("sightings"), sightings);
  EXPECT_LE(results.at("median_px"), results.at("median_px_before_adjustment"));

  succeeds(run_vantage({"scene", "build", "--poses", model_, "--images", images_, "-o", place_,
                        "--preset", "balanced", "--disparities=0:20"}));
  const Eigen::Vector3d middle(0.5, 0.5, 0.05);
  const PosedCamera wanted = camera(middle, turn(0.2, 0.3, 1));
  const Eigen::Matrix3d r = wanted.rotation * first_turn.transpose();
  write_pose(r, -r * (first_turn * (middle - cameras_[0].centre())));
  succeeds(run_vantage({"scene", "view", place_, "--pose", pose_, "-o", folder_ / "view.png"}));
  EXPECT_GT(psnr(folder_ / "view.png", wanted), 22);
  succeeds(run_vantage({"scene", "cloud", place_, "-o", folder_ / "cloud.ply"}));
}

TEST_F(EstimatedScene, ImagesThatDoNotBelongAreNamed) {
  LayeredSceneOptions other = small_scene(240, 180);
  other.seed = 9;
  other.has_boards = true;
  write_photograph(images_ + "/4.png",
                   LayeredScene(other, execution_).render(SceneView{}, 50).image);
  const ProcessResult found = poses({});
  expect_failure(found, 3, "4.png is left out: no pair joins it to the other images");
  EXPECT_THAT(found.err, HasSubstr("4 of 5 images"));
  EXPECT_THAT(found.err, HasSubstr("lengths have no scale"));
  EXPECT_EQ(model_images(model_).size(), 4U);
}

TEST_F(EstimatedScene, WrongInputIsRefused) {
  const auto problem = [&](const Words& more) {
    const ProcessResult result = poses(more);
    EXPECT_NE(result.exit_code, 0);
    EXPECT_FALSE(fs::exists(model_ + "/images.txt"));
    return result.err;
  };
  EXPECT_THAT(problem({"--known-distance", "0:0:1"}), HasSubstr("two different images"));
  EXPECT_THAT(problem({"--known-distance", "0:7:1"}), HasSubstr("names image 7, expected 0 to 3"));
  EXPECT_THAT(problem({"--partners", "0"}), HasSubstr("partners is 0"));
  write_file(lens_, "OPENCV");
  EXPECT_THAT(problem({"--intrinsics", lens_}), HasSubstr("lens.txt"));
  write_file(lens_, "");
  const LayeredSceneOptions other = small_scene(200, 180);
  write_photograph(images_ + "/9.png",
                   LayeredScene(other, execution_).render(SceneView{}, 0).image);
  EXPECT_THAT(problem({}), HasSubstr("9.png is 200x180, expected 240x180 as"));
  write_file(images_ + "/9.png", "no image");
  EXPECT_THAT(problem({}), HasSubstr("9.png"));
  for (const char* name : {"1", "2", "3", "9"}) {
    fs::remove(images_ + "/" + name + ".png");
  }
  EXPECT_THAT(problem({}), HasSubstr("there are 1 images, expected 2 to 500"));
}

// One behind the other: poses are found, but no two images can be rectified.
TEST(EstimatedCameras, WhatSceneBuildWillRefuseIsToldAtOnce) {
  const TemporaryFolder folder;
  std::string cameras;
  for (const char* const t : {"0, 0, 0", "0, 0, -2", "0, 0, -4"}) {
    cameras += fmt::format(
        "[[view]]\nK = [400, 0, 160, 0, 400, 120, 0, 0, 1]\n"
        "R = [1, 0, 0, 0, 1, 0, 0, 0, 1]\nt = [{}]\n",
        t);
  }
  write_file(folder / "cameras.toml", cameras);
  succeeds(run_vantage({"generate", "scene", "--width", "320", "--height", "240", "--pose",
                        folder / "cameras.toml", "-o", folder / "row", "--quiet"}));
  const ProcessResult result = succeeds(run_vantage(
      {"scene", "poses", "--images", folder / "row/camera-*.png", "-o", folder / "model"}));
  EXPECT_THAT(result.err, HasSubstr("warning: 'vantage scene build' will refuse this: "));
  const std::string why = "no other camera beside it looks the same way";
  EXPECT_THAT(result.err, HasSubstr(why));
  expect_failure(run_vantage({"scene", "build", "--poses", folder / "model", "--images",
                              folder / "row", "-o", folder / "scene"}),
                 1, why);
}

}  // namespace vantage::estimated_scene_test
