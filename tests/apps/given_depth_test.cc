// Depth maps in place of disparity maps.
#include <cmath>

#include "tests/apps/pair_fixture.h"

namespace vantage::given_depth_test {

/// f · b / (d + doffs) with f = 300 px, b = 0.12 m, doffs = 12 px: depths of 1.6 to 3 m.
class GivenDepth : public PairTest {
 protected:
  static constexpr double kProduct = 300 * 0.12;
  static constexpr double kDoffs_px = 12;

  GivenDepth() {
    for (const auto& [name, map] :
         {std::pair("left", &pair_.left_disparity), {"right", &pair_.right_disparity}}) {
      Image<float> depth_m(map->width(), map->height());
      for (int y = 0; y < map->height(); ++y) {
        for (int x = 0; x < map->width(); ++x) {
          depth_m.at(x, y) = static_cast<float>(kProduct / (map->at(x, y) + kDoffs_px));
        }
      }
      write_disparity(folder_ / (std::string(name) + ".pfm"), map->view());
      write_depth(folder_ / (std::string(name) + "-z.npy"), depth_m.view());
      write_depth(folder_ / (std::string(name) + "-z.png"), depth_m.view());
    }
  }

  [[nodiscard]] std::string file(const std::string& name) const { return folder_ / name; }

  const Words cameras_ = {"--focal-length", "300", "--baseline", "0.12", "--doffs", "12"};
  const Words depths_ = joined({"--given", "depth"}, cameras_);
};

TEST_F(GivenDepth, ViewsAreThoseOfTheDisparities) {
  const auto synth = [&](const std::string& out, const std::string& ending, const Words& more) {
    return run_vantage(
        joined({"synth", left_, right_, "--left-disparity", file("left" + ending),
                "--right-disparity", file("right" + ending), "--view", "0.5", "-o", file(out)},
               more));
  };
  succeeds(synth("a.png", ".pfm", {"--quiet"}));
  const ProcessResult of_depths = succeeds(synth("b.png", "-z.npy", depths_));
  EXPECT_THAT(of_depths.err, HasSubstr("left-z.npy: depths are floats, taken as metres: median"));
  const Words compare = {"eval",        "--views",  file("b.png"),
                         file("a.png"), "--report", file("r.json")};
  succeeds(run_vantage(compare));
  const auto scores = read_json(file("r.json"))["results"];
  EXPECT_LT(scores["mean_absolute_difference"], 0.01);
  expect_one_line(synth("c.png", "-z.npy", {"--given", "depth"}), 2, "synth", "--calibration");
  expect_one_line(synth("c.png", ".pfm", {"--doffs", "1", "--focal-length", "2"}), 2, "synth",
                  "without --given depth");
  expect_one_line(synth("c.png", ".pfm", {"--depth-scale", "1000"}), 2, "synth",
                  "without --given depth");
}

TEST_F(GivenDepth, ReprojectAndEvalTakeThem) {
  const ProcessResult reprojected = succeeds(run_vantage(
      joined({"reproject", file("left-z.npy"), "--depth", file("z.npy"), "--cloud", file("c.ply")},
             depths_)));
  EXPECT_THAT(reprojected.err, HasSubstr("points are grey without --image"));
  const DisparityMap given = read_disparity(file("left-z.npy"));
  const DisparityMap made = read_disparity(file("z.npy"));
  for (int x = 0; x < given.width(); ++x) {
    EXPECT_NEAR(made.at(x, 20), given.at(x, 20), 1e-5);
  }
  const std::string cloud = read_file(file("c.ply"));
  EXPECT_EQ(cloud.substr(cloud.size() - 3), "\x80\x80\x80");

  const auto bad = [&](const Words& arguments) {
    succeeds(run_vantage(joined(joined({"eval"}, arguments), {"--report", file("r.json")})));
    return read_json(file("r.json"))["results"]["a99_px"].get<double>();
  };
  EXPECT_LT(bad(joined({file("left-z.npy"), file("left.pfm")}, depths_)), 1e-4);
  // Millimetres of 16 bits: an error of 0.5 mm at 1.6 m is 0.007 px.
  EXPECT_LT(bad(joined({file("left-z.png"), file("left.pfm")}, depths_)), 0.01);
  EXPECT_GT(bad(joined({file("left-z.png"), file("left.pfm"), "--depth-scale", "500"}, depths_)),
            1);
}

}  // namespace vantage::given_depth_test
