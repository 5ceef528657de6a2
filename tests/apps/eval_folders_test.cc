// vantage eval over data sets, and submissions.
#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>

#include "tests/apps/pair_fixture.h"

namespace vantage::eval_folders_test {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

class EvalFolders : public testing::Test {
 protected:
  /// A map of 6×1 pixels.
  static DisparityMap map_of(const std::vector<float>& values) {
    DisparityMap map(static_cast<int>(values.size()), 1);
    std::copy(values.begin(), values.end(), map.row(0));
    return map;
  }
  void write(const std::string& name, const std::vector<float>& values) const {
    std::filesystem::create_directories(std::filesystem::path(folder_ / name).parent_path());
    write_disparity(folder_ / name, map_of(values).view());
  }
  void write_grey_values(const std::string& name, const std::vector<int>& values) const {
    std::filesystem::create_directories(std::filesystem::path(folder_ / name).parent_path());
    Mask mask(static_cast<int>(values.size()), 1);
    std::copy(values.begin(), values.end(), mask.row(0));
    write_mask(folder_ / name, mask.view());
  }
  /// KITTI 2015: errors 0, 3.5 of 50 (7 %), 3.5 of 100 (3.5 %), unknown, 2, and no truth.
  void write_kitti() const {
    write("kitti/disp_occ_0/000000_10.png", {20, 50, 100, 40, 30, kNan});
    write("kitti/disp_noc_0/000000_10.png", {20, 50, kNan, kNan, 30, kNan});
    write_grey_values("kitti/obj_map/000000_10.png", {0, 1, 0, 2, 0, 0});
    write("kitti/disp_occ_0/000001_10.png", {8, 8, 8, 8, kNan, kNan});
    write("kitti/disp_noc_0/000001_10.png", {8, 8, 8, 8, kNan, kNan});
    write_grey_values("kitti/obj_map/000001_10.png", {0, 0, 0, 0, 0, 0});
    write("maps/disparity/000000.pfm", {20, 53.5F, 103.5F, kNan, 32, 5});
  }
  [[nodiscard]] nlohmann::json scores(const Words& arguments) const {
    result_ = succeeds(
        run_vantage(joined(joined({"eval"}, arguments), Words{"--report", folder_ / "r.json"})));
    return read_json(folder_ / "r.json")["results"];
  }
  static nlohmann::json row(const nlohmann::json& results, const std::string& scene,
                            const std::string& region) {
    for (const auto& one : results["scores"]) {
      if (one["scene"] == scene && one["region"] == region) {
        return one;
      }
    }
    ADD_FAILURE() << scene << " " << region;
    return {};
  }
  [[nodiscard]] std::string text_of(const std::string& name) const {
    std::ifstream file(folder_ / name);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
  }

  TemporaryFolder folder_;
  mutable ProcessResult result_;
};

TEST_F(EvalFolders, KittiHasD1OfRegionsAndNamesMissingMaps) {
  write_kitti();
  const Words call = {folder_ / "maps", folder_ / "kitti", "--csv", folder_ / "t.csv"};
  const nlohmann::json results = scores(call);
  EXPECT_EQ(results["missing"], nlohmann::json({"000001_10"}));
  EXPECT_THAT(result_.err, HasSubstr("1 of 2 maps are missing"));
  EXPECT_THAT(result_.err, HasSubstr("000001_10"));
  const auto all = row(results, "000000_10", "all");
  EXPECT_EQ(all["evaluated_pixels"], 5);
  EXPECT_EQ(all["d1_percent"], 40);     // 3.5 of 50, and unknown
  EXPECT_EQ(all["bad_3_percent"], 60);  // also 3.5 of 100
  EXPECT_NEAR(row(results, "000000_10", "noc")["d1_percent"], 100.0 / 3, 1e-9);
  EXPECT_EQ(row(results, "000000_10", "fg")["d1_percent"], 100);
  EXPECT_EQ(row(results, "000000_10", "bg")["d1_percent"], 0);

  write("maps/disparity/000001.pfm", {8, 8, 8, 12, 1, 1});
  const nlohmann::json both = scores(call);
  EXPECT_EQ(both["missing"], nlohmann::json::array());
  EXPECT_THAT(result_.err,
              testing::AllOf(HasSubstr("taken as KITTI 2015"), testing::Not(HasSubstr("missing"))));
  EXPECT_EQ(row(both, "mean", "all")["d1_percent"], (40 + 25) / 2.0);
  EXPECT_NEAR(row(both, "all pixels", "all")["d1_percent"], 100.0 * 3 / 9, 1e-9);
  EXPECT_TRUE(row(both, "all pixels", "all")["a50_px"].is_null());
  EXPECT_EQ(row(both, "mean", "fg")["d1_percent"], 100);  // of the one scene that has any
  EXPECT_THAT(result_.out, HasSubstr("all pixels"));
  EXPECT_THAT(text_of("t.csv"), testing::StartsWith("scene,region,map,evaluated_pixels,"));
}

TEST_F(EvalFolders, ScenesOfMiddleburyHaveMasksAndPublishedScales) {
  write("data/Piano/disp0GT.pfm", {10, 10, 10, 10, 10, kNan});
  write_grey_values("data/Piano/mask0nocc.png", {255, 255, 255, 128, 128, 0});
  // 450 px wide: 4 per pixel.
  std::vector<int> stored(450, 40);
  stored[0] = 0;
  write_grey_values("data/cones/disp2.png", stored);
  write("maps/Piano/disp0Best.pfm", {10, 11.5F, 10, 13, 10, 10});
  write("maps/cones.pfm", std::vector<float>(450, 10.25F));
  const nlohmann::json results = scores({folder_ / "maps", folder_ / "data"});
  EXPECT_EQ(row(results, "Piano", "all")["bad_1_percent"], 40);
  EXPECT_NEAR(row(results, "Piano", "noc")["bad_1_percent"], 100.0 / 3, 1e-9);
  EXPECT_EQ(row(results, "Piano", "noc")["bad_2_percent"], 0);
  EXPECT_EQ(row(results, "cones", "all")["evaluated_pixels"], 449);
  EXPECT_EQ(row(results, "cones", "all")["average_px"], 0.25);

  // Not of this scene.
  write("maps/cones_half.pfm", std::vector<float>(450, 1));
  EXPECT_EQ(row(scores({folder_ / "maps", folder_ / "data"}), "cones", "all")["average_px"], 0.25);
  write("maps/cones.png", std::vector<float>(450, 1));
  expect_one_line(run_vantage({"eval", folder_ / "maps", folder_ / "data"}), 1, "eval",
                  "both maps");
}

TEST_F(EvalFolders, SubmissionsHaveTheNamesOfTheirServers) {
  write_kitti();
  write("maps/disparity/000001.pfm", {8, 8, 8, 12, 1, 1});
  const std::string out = folder_ / "out";
  const auto submit = [&](const Words& more) {
    return run_vantage(joined(Words{"eval", folder_ / "maps"}, more));
  };
  const std::string kitti = folder_ / "kitti";
  succeeds(submit({kitti, "--submission", "kitti2015", "-o", out}));
  const Photograph png = read_photograph(out + "/disp_0/000000_10.png");
  EXPECT_EQ(std::get<Image<std::uint16_t>>(png.pixels).at(1, 0), 53.5 * 256);
  EXPECT_EQ(std::get<Image<std::uint16_t>>(png.pixels).at(3, 0), 0);
  EXPECT_TRUE(std::filesystem::exists(out + "/disp_0/000001_10.png"));
  // Nothing is written over.
  expect_one_line(submit({kitti, "--submission", "kitti2015", "-o", out, "--quiet"}), 1, "eval",
                  "exists");
  succeeds(submit({kitti, "--submission", "kitti2012", "-o", out, "--quiet"}));
  EXPECT_TRUE(std::filesystem::exists(out + "/000001_10.png"));

  // Test sets have images only.
  write_grey_values("eth/lake_1l/im0.png", {1, 2});
  write_grey_values("trainingQ/Piano/im0.png", {1, 2});
  write("maps/lake_1l.pfm", {1, kNan});
  write("maps/Piano.pfm", {1, 2});
  succeeds(submit({folder_ / "eth", "--submission", "eth3d", "-o", out, "--time", "1.5"}));
  EXPECT_EQ(text_of("out/low_res_two_view/lake_1l.txt"), "runtime 1.5\n");
  EXPECT_EQ(read_disparity(out + "/low_res_two_view/lake_1l.pfm").at(0, 0), 1);
  std::ofstream(folder_ / "run.json") << R"({"seconds": {"wall": 9}, "results": {"frames": 4}})";
  succeeds(submit({folder_ / "trainingQ", "--submission", "middlebury", "-o", out, "--time-report",
                   folder_ / "run.json", "--method-name", "SGM"}));
  EXPECT_EQ(text_of("out/trainingQ/Piano/timeSGM.txt"), "2.25\n");
  EXPECT_TRUE(std::filesystem::exists(out + "/trainingQ/Piano/disp0SGM.pfm"));
}

TEST_F(EvalFolders, BadInputIsOneLine) {
  write_kitti();
  write_grey_values("eth/lake_1l/im0.png", {1, 2});
  const std::string maps = folder_ / "maps";
  const std::string kitti = folder_ / "kitti";
  const std::vector<std::pair<Words, int>> cases = {
      {{maps + "/disparity/000000.pfm", kitti}, 2},
      {{maps, kitti, "--submission", "kitti2015"}, 2},
      {{maps, kitti, "--submission", "eth3d", "-o", folder_ / "o"}, 2},
      {{maps, kitti, "--submission", "kitti2015", "-o", folder_ / "o", "--time", "1"}, 2},
      {{maps, kitti, "-o", folder_ / "o"}, 2},
      {{maps, folder_ / "eth"}, 1},
      {{kitti + "/obj_map", kitti + "/obj_map/none"}, 1},
      {{maps, kitti, "--given", "depth"}, 2}};
  for (const auto& [arguments, exit_code] : cases) {
    expect_one_line(run_vantage(joined({"eval"}, arguments)), exit_code, "eval");
  }
}

}  // namespace vantage::eval_folders_test
