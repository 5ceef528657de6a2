// Runs that correct the rows of right images: results are those of `match` and `synth`.

#include "tests/apps/run_fixture.h"

namespace vantage::run_rows_test {

constexpr int kSceneWidth = 320;
constexpr int kSceneHeight = 240;

class RunRows : public testing::Test {
 protected:
  /// A pair whose right image is `rows` rows lower than the left one, as left/NAME and right/NAME.
  void put_pair(const std::string& name, int seed, int rows) const {
    const std::string scene = folder_ / "scene";
    succeeds(run_vantage({"generate", "scene", "-o", scene, "--overwrite", "--width",
                          std::to_string(kSceneWidth), "--height", std::to_string(kSceneHeight),
                          "--seed", std::to_string(seed)}));
    fs::create_directories(folder_ / "left");
    fs::create_directories(folder_ / "right");
    fs::copy_file(scene + "/left.png", left(name));
    const Photograph right_image = read_photograph(scene + "/right.png");
    const auto& pixels = std::get<Image<std::uint8_t>>(right_image.pixels);
    Image<std::uint8_t> lower(pixels.width(), pixels.height(), pixels.channels());
    for (int y = 0; y < pixels.height(); ++y) {
      const std::uint8_t* const row = pixels.row(std::clamp(y - rows, 0, pixels.height() - 1));
      std::copy(row, row + pixels.width() * pixels.channels(), lower.row(y));
    }
    write_photograph(right(name), {std::move(lower)});
  }
  [[nodiscard]] std::string left(const std::string& name) const {
    return folder_ / ("left/" + name + ".png");
  }
  [[nodiscard]] std::string right(const std::string& name) const {
    return folder_ / ("right/" + name + ".png");
  }

  TemporaryFolder folder_;
  const Words method_ = words("--preset realtime --disparities 0:31 --quiet");
};

TEST_F(RunRows, UnrelatedPairsAreCorrectedEachByItself) {
  put_pair("straight", 1, 0);
  put_pair("lower", 2, 2);
  put_pair("higher", 3, -1);
  write_file(folder_ / "list.csv",
             "name,left,right\nstraight,left/straight.png,right/straight.png\n"
             "lower,left/lower.png,right/lower.png\nhigher,left/higher.png,right/higher.png\n");
  const std::string out = folder_ / "out";
  const std::string report = folder_ / "report.json";
  succeeds(run_vantage(joined({"run", "--pairs", folder_ / "list.csv", "-o", out, "--save",
                               "disparity,right-disparity", "--report", report},
                              method_)));
  std::map<int, std::string> remarks;
  const nlohmann::json results = read_json(report)["results"];
  for (const nlohmann::json& remark : results["remarks"]) {
    remarks[remark["frame"]] += remark["text"];
  }
  EXPECT_THAT(remarks[0], Not(HasSubstr("rows: right")));
  EXPECT_THAT(remarks[1], HasSubstr("rows: right image 2.00 px lower; corrected"));
  EXPECT_THAT(remarks[2], HasSubstr("px higher; corrected"));
  for (const std::string name : {"straight", "lower", "higher"}) {
    const std::string map = folder_ / (name + ".pfm");
    const std::string map_right = folder_ / (name + "-right.pfm");
    succeeds(run_vantage(joined(
        {"match", left(name), right(name), "-o", map, "--output-right", map_right}, method_)));
    EXPECT_TRUE(read_file(out + "/disparity/" + name + ".pfm") == read_file(map)) << name;
    EXPECT_TRUE(read_file(out + "/right-disparity/" + name + ".pfm") == read_file(map_right))
        << name;
  }
}

/// Views take the colours of the photographs as they were given, not of the rectified ones.
TEST_F(RunRows, ViewsOfARigThatIsSlightlyWrongAreThoseOfSynth) {
  put_pair("a", 4, 5);
  // Explains three of the five rows, and needs rectification.
  write_file(folder_ / "rig.yml",
             "%YAML:1.0\nM1: [300, 0, 160, 0, 300, 120, 0, 0, 1]\nD1: [-0.02, 0, 0, 0]\n"
             "M2: [300, 0, 160, 0, 300, 123, 0, 0, 1]\nD2: [-0.02, 0, 0, 0]\n"
             "R: [1, 0, 0, 0, 1, 0, 0, 0, 1]\nT: [-1, 0, 0]\n");
  const Words rig = {"--calibration", folder_ / "rig.yml", "--view", "0.5"};
  const std::string out = folder_ / "out";
  succeeds(
      run_vantage(joined(joined({"run", "--left", folder_ / "left", "--right", folder_ / "right",
                                 "-o", out, "--save", "views", "--report", folder_ / "report.json"},
                                rig),
                         method_)));
  EXPECT_TRUE(read_json(folder_ / "report.json")["results"]["rows"]["corrected"].get<bool>());
  const std::string view = folder_ / "view.png";
  succeeds(run_vantage(joined(joined({"synth", left("a"), right("a"), "-o", view}, rig), method_)));
  const FolderContent made = results_in(out);
  ASSERT_EQ(made.size(), 1U);
  EXPECT_TRUE(made.begin()->second == read_file(view)) << made.begin()->first;
}

}  // namespace vantage::run_rows_test
