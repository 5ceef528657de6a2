#include <cstring>

#include "tests/apps/posed_cameras.h"

namespace vantage::posed_scene_test {

/// The cameras with their poses as a COLMAP model in DIR/model.
class PosedScene : public PosedCameras {
 protected:
  PosedScene() : PosedCameras(160, 120) { write_model(model_, {0, 0, 0, 0}); }

  /// With camera i turned by errors[i] degrees about its X axis from where it is.
  void write_model(const std::string& folder, const std::vector<double>& errors) const {
    fs::create_directories(folder);
    const Eigen::Matrix3d& k = cameras_[0].matrix;
    write_file(folder + "/cameras.txt", fmt::format("1 PINHOLE 160 120 {} {} {} {}\n", k(0, 0),
                                                    k(1, 1), k(0, 2) + 0.5, k(1, 2) + 0.5));
    std::string images;
    for (std::size_t i = 0; i < cameras_.size(); ++i) {
      Eigen::Matrix3d rotation = cameras_[i].rotation;
      if (errors[i] != 0) {
        rotation = turn(errors[i], 0, 0) * rotation;
      }
      const Eigen::Quaterniond q(rotation);
      const Eigen::Vector3d t = -rotation * cameras_[i].centre();
      images += fmt::format("{} {} {} {} {} {} {} {} 1 {}.png\n\n", i + 1, q.w(), q.x(), q.y(),
                            q.z(), t.x(), t.y(), t.z(), i);
    }
    write_file(folder + "/images.txt", images);
  }

  [[nodiscard]] ProcessResult build(const Words& more = {}) const {
    return run_vantage(joined({"scene", "build", "-o", place_, "--images", images_, "--preset",
                               "balanced", "--disparities=0:14"},
                              more));
  }
  [[nodiscard]] ProcessResult view(const Words& more) const {
    return run_vantage(joined({"scene", "view", place_, "--quiet"}, more));
  }
};

TEST_F(PosedScene, ViewsOfAColmapModelComeFromSeveralImages) {
  succeeds(build({"--poses", model_}));
  EXPECT_THAT(run_vantage({"scene", "info", place_}).out,
              AllOf(HasSubstr("images 4, 160x120 pixels"), HasSubstr("0 refused")));

  const PosedCamera wanted = camera({0.5, 0.5, 0.05}, turn(0.2, 0.3, 1));
  write_pose(wanted.rotation, wanted.translation);
  const auto psnr_of = [&](const std::string& sources) {
    succeeds(view({"--pose", pose_, "--sources", sources, "-o", folder_ / "v.png"}));
    return psnr(folder_ / "v.png", wanted);
  };
  const double of_two = psnr_of("2");
  const double of_four = psnr_of("4");
  EXPECT_GT(of_two, 21);
  EXPECT_GT(of_four, of_two + 0.5);

  // At an image the view is that image, but for what its map does not know.
  succeeds(view({"--between", "1:2:0", "-o", folder_ / "same.png"}));
  EXPECT_GT(psnr(folder_ / "same.png", cameras_[1]), 30);
  succeeds(view({"--sweep", "0:3:3", "-o", folder_ / "s%d.png"}));
  EXPECT_TRUE(fs::exists(folder_ / "s2.png"));
}

/// Positions of a binary PLY file with normals and colours.
std::vector<Eigen::Vector3d> points_in(const std::string& file) {
  const std::string bytes = read_file(file);
  const std::string end = "end_header\n";
  constexpr std::size_t kVertexBytes = 6 * sizeof(float) + 3;
  std::vector<Eigen::Vector3d> points;
  for (std::size_t at = bytes.find(end) + end.size(); at < bytes.size(); at += kVertexBytes) {
    Eigen::Vector3f point;
    std::memcpy(point.data(), bytes.data() + at, sizeof(point));
    points.emplace_back(point.cast<double>());
  }
  EXPECT_THAT(bytes, HasSubstr(fmt::format("element vertex {}\n", points.size())));
  return points;
}

TEST_F(PosedScene, CloudOfAColmapModelLiesOnTheSurfaces) {
  succeeds(build({"--poses", model_}));
  const std::string file = folder_ / "cloud.ply";
  succeeds(run_vantage({"scene", "cloud", place_, "-o", file, "--threads", "1"}));
  std::vector<DisparityMap> truths;
  for (const PosedCamera& camera : cameras_) {
    truths.push_back(scene_.render(camera, 0).disparity);
  }
  const std::vector<Eigen::Vector3d> points = points_in(file);
  // Nearly all that the first image shows, and what only others show.
  EXPECT_GT(points.size(), 160U * 120U * 7 / 10);
  EXPECT_LT(points.size(), 160U * 120U * 3 / 2);
  int near = 0;
  for (const Eigen::Vector3d& point : points) {
    double best_px = 99;  // error of the disparity in the image that fits best
    for (std::size_t i = 0; i < cameras_.size(); ++i) {
      const PosedCamera& camera = cameras_[i];
      const Eigen::Vector3d seen = camera.rotation * point + camera.translation;
      const Eigen::Vector2d at = (camera.matrix * seen).hnormalized().array().round();
      if (seen.z() > 0 && at.x() >= 0 && at.x() < 160 && at.y() >= 0 && at.y() < 120) {
        const double truth =
            static_cast<double>(truths[i].at(static_cast<int>(at.x()), static_cast<int>(at.y())));
        best_px = std::min(best_px, std::abs(camera.matrix(0, 0) / seen.z() - truth));
      }
    }
    near += best_px < 0.5 ? 1 : 0;
  }
  EXPECT_GT(near, static_cast<int>(points.size()) * 93 / 100);

  const std::string again = folder_ / "again.ply";
  succeeds(run_vantage({"scene", "cloud", place_, "-o", again, "--threads", "2"}));
  EXPECT_EQ(read_file(again), read_file(file));
  const auto problem = [&](const Words& more) {
    const ProcessResult result =
        run_vantage(joined({"scene", "cloud", place_, "-o", folder_ / "wrong.ply"}, more));
    EXPECT_NE(result.exit_code, 0);
    EXPECT_FALSE(fs::exists(folder_ / "wrong.ply"));
    return result.err;
  };
  EXPECT_THAT(problem({"--max-depth", "0.01"}), HasSubstr("no point is seen at one depth"));
  EXPECT_THAT(problem({"--min-images", "33"}), HasSubstr("min-images is 33"));
  EXPECT_THAT(run_vantage({"scene", "cloud", place_, "-o", place_ + "/scene.json"}).err,
              HasSubstr("scene.json"));
}

TEST_F(PosedScene, WrongPosesAreCorrectedAndHopelessEdgesLeftOut) {
  const std::string noisy = folder_ / "noisy";
  write_model(noisy, {0, 0.5, 0, 0});  // a pixel and a half
  succeeds(build({"--poses", noisy, "--report", folder_ / "build.json"}));
  const auto results = read_json(folder_ / "build.json").at("results");
  EXPECT_GE(results.at("poses_corrected"), 1);
  for (const auto& edge : results.at("edges_matched")) {
    if (edge.contains("pose_corrected_degrees")) {
      EXPECT_NEAR(edge.at("pose_corrected_degrees"), 0.5, 0.4);
      EXPECT_LT(edge.at("rectification").at("systematic_px"), 0.6);
    }
  }

  write_model(noisy, {0, 0, 0, 25});
  expect_failure(build({"--poses", noisy}), 1,
                 "3.png: all its edges were refused, expected at least one");
}

TEST_F(PosedScene, TumPosesBelongToImagesNamedAfterTheirTimes) {
  const auto write_trajectory = [&](double start) {
    std::string text = "# time tx ty tz qx qy qz qw\n";
    for (std::size_t i = 0; i < 3; ++i) {
      const Eigen::Quaterniond q(Eigen::Matrix3d(cameras_[i].rotation.transpose()));
      const Eigen::Vector3d c = cameras_[i].centre();
      text += fmt::format("{} {} {} {} {} {} {} {}\n", start + static_cast<double>(i), c.x(), c.y(),
                          c.z(), q.x(), q.y(), q.z(), q.w());
    }
    write_file(folder_ / "tum.txt", text);
  };
  write_trajectory(0.01);  // images are 0.png to 3.png, the last one without a pose
  write_lens(folder_ / "camera.txt");
  EXPECT_THAT(build({"--poses", folder_ / "tum.txt"}).err, HasSubstr("expected --intrinsics too"));
  const ProcessResult built =
      succeeds(build({"--poses", folder_ / "tum.txt", "--intrinsics", folder_ / "camera.txt"}));
  EXPECT_THAT(built.err, HasSubstr("3 images, 3 edges"));
  EXPECT_THAT(built.err, HasSubstr("note: 1 of 4 images are left out: "));
  EXPECT_THAT(read_file(place_ + "/scene.json"),
              Not(HasSubstr("corrected_degrees")));  // the poses fit

  write_trajectory(100);
  EXPECT_THAT(build({"--poses", folder_ / "tum.txt", "--intrinsics", folder_ / "camera.txt"}).err,
              HasSubstr("no pose is within 0.02 s of an image"));
}

TEST_F(PosedScene, SaysWhatIsWrong) {
  const auto problem = [&](const Words& more) {
    const ProcessResult result = build(more);
    EXPECT_NE(result.exit_code, 0);
    return result.err;
  };
  EXPECT_THAT(problem({"--poses", model_, "--grid", "2x2"}), HasSubstr("grid"));
  EXPECT_THAT(problem({"--poses", model_, "--intrinsics", model_ + "/cameras.txt"}),
              HasSubstr("--intrinsics is given with a model"));
  EXPECT_THAT(problem({"--poses", model_, "--neighbours", "0"}), HasSubstr("neighbours is 0"));
  EXPECT_THAT(problem({"--neighbours", "3"}), HasSubstr("neighbours"));
  fs::rename(images_ + "/3.png", images_ + "/x.png");
  EXPECT_THAT(problem({"--poses", model_}), HasSubstr("3.png is missing, expected an image of"));
  fs::rename(images_ + "/x.png", images_ + "/3.png");
  write_file(model_ + "/cameras.txt", "1 PINHOLE 320 200 600 600 160 120\n");
  EXPECT_THAT(problem({"--poses", model_}), HasSubstr("expected 320×200 as its camera"));
}

}  // namespace vantage::posed_scene_test
