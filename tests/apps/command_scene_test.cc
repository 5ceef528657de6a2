#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "engine/evaluation/view_evaluation.h"
#include "engine/generation/layered_scene.h"
#include "engine/io/photograph_io.h"
#include "engine/io/video_io.h"
#include "tests/apps/pair_fixture.h"
#include "tests/apps/vantage_process.h"
#include "tests/temporary_folder.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// A grid of 3 by 2 cameras, half a baseline apart, in DIR/images.
class SceneCommand : public testing::Test {
 protected:
  static LayeredSceneOptions small_scene() {
    LayeredSceneOptions options;
    options.width_px = 106;
    options.height_px = 74;
    options.samples_per_side = 2;
    return options;
  }

  SceneCommand() {
    fs::create_directory(images_);
    for (int i = 0; i < 6; ++i) {
      write_photograph(images_ + "/" + std::to_string(i) + ".png",
                       truth_at(0.5 * (i % 3), 0.5 * (i / 3)));
    }
  }

  [[nodiscard]] Photograph truth_at(double x, double y) const {
    return scene_.render(SceneView{x, y}, 0).image;
  }
  [[nodiscard]] double psnr(const std::string& file, double x, double y) const {
    return evaluate_view(read_photograph(file), truth_at(x, y), execution_).psnr_db;
  }
  [[nodiscard]] ProcessResult build(const std::vector<std::string>& more) const {
    std::vector<std::string> arguments = {"scene",    "build",   "-o", place_, "--disparities=0:8",
                                          "--preset", "balanced"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_vantage(arguments);
  }
  [[nodiscard]] ProcessResult build_grid(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments = {"--images", images_,     "--grid",
                                          "3x2",      "--spacing", "0.5,0.5"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return build(arguments);
  }
  [[nodiscard]] ProcessResult view(const std::vector<std::string>& more) const {
    std::vector<std::string> arguments = {"scene", "view", place_};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_vantage(arguments);
  }
  static nlohmann::json json_in(const std::string& file) {
    return nlohmann::json::parse(read_file(file));
  }

  mutable Execution execution_{{.threads = 2}};
  LayeredScene scene_{small_scene(), execution_};
  TemporaryFolder folder_;
  std::string images_ = folder_ / "images";
  std::string place_ = folder_ / "scene";
};

TEST_F(SceneCommand, BuildsAGridAndRendersViewsOfIt) {
  const ProcessResult built = build_grid({"--report", folder_ / "build.json"});
  ASSERT_EQ(built.exit_code, 0) << built.err;
  EXPECT_THAT(built.err, HasSubstr("6 images, 7 edges, 7 of them matched now"));
  const nlohmann::json build_report = json_in(folder_ / "build.json");
  EXPECT_EQ(build_report.at("results").at("triangles"), 4);
  EXPECT_EQ(build_report.at("results").at("edges_matched").size(), 7U);
  EXPECT_GT(build_report.at("cells"), 0);
  EXPECT_EQ(build_report.at("settings").at("grid"), "3x2");

  const ProcessResult seen =
      view({"--at", "0.3,0.2", "--at=0.75,0", "-o", folder_ / "v%d.png", "--hole-mask",
            folder_ / "h%d.png", "--report", folder_ / "view.json"});
  ASSERT_EQ(seen.exit_code, 0) << seen.err;
  EXPECT_THAT(seen.err, testing::Not(HasSubstr("outside")));
  EXPECT_GE(psnr(folder_ / "v0.png", 0.3, 0.2), 29);
  EXPECT_GE(psnr(folder_ / "v1.png", 0.75, 0), 29);
  EXPECT_TRUE(fs::exists(folder_ / "h1.png"));
  const nlohmann::json views = json_in(folder_ / "view.json").at("results").at("views");
  ASSERT_EQ(views.size(), 2U);
  EXPECT_EQ(views[0].at("from").size(), 3U);
  EXPECT_EQ(views[0].at("x"), 0.3);

  // Where a camera stood its photograph comes back.
  ASSERT_EQ(view({"--at", "1,0.5", "-o", folder_ / "same.png"}).exit_code, 0);
  EXPECT_EQ(read_file(folder_ / "same.png"), read_file(images_ + "/5.png"));

  const ProcessResult info = run_vantage({"scene", "info", place_});
  EXPECT_EQ(info.exit_code, 0);
  EXPECT_THAT(info.out, AllOf(HasSubstr("../images/4.png"), HasSubstr("1-4 along y, length 0.5"),
                              HasSubstr("disparities 0:8"), HasSubstr("triangles")));
}

TEST_F(SceneCommand, AListOfPositionsMayLeaveImagesOut) {
  write_file(images_ + "/list.csv", "image,x,y\n0.png,0,0\n2.png,10,0\n3.png,0,5\n5.png,10,5\n");
  ASSERT_EQ(build({"--positions", images_ + "/list.csv"}).exit_code, 0);
  ASSERT_EQ(view({"--at", "5,5", "-o", folder_ / "v.png"}).exit_code, 0);
  EXPECT_GE(psnr(folder_ / "v.png", 0.5, 0.5), 26);
}

TEST_F(SceneCommand, ASecondBuildKeepsWhatIsThere) {
  ASSERT_EQ(build_grid().exit_code, 0);
  const std::string map = place_ + "/maps/001-004-second.pfm";
  const std::string before = read_file(map);
  const ProcessResult again = build_grid({"--threads", "1"});
  EXPECT_EQ(again.exit_code, 0);
  EXPECT_THAT(again.err, HasSubstr("7 edges, 0 of them matched now"));
  fs::remove(map);
  EXPECT_THAT(view({"--at", "0.5,0.25", "-o", folder_ / "v.png"}).err,
              HasSubstr("001-004-second.pfm"));
  EXPECT_THAT(build_grid({"--threads", "1"}).err, HasSubstr("1 of them matched now"));
  EXPECT_EQ(read_file(map), before);
  EXPECT_THAT(build_grid({"--window", "5"}).err, HasSubstr("7 of them matched now"));
}

TEST_F(SceneCommand, MakesMoviesAndSaysWhatLiesOutside) {
  ASSERT_EQ(build_grid({"--quiet"}).exit_code, 0);
  const ProcessResult movie =
      view({"--sweep", "0,0:1.1,0.5:8", "--fps", "8", "-o", folder_ / "movie.mp4"});
  ASSERT_EQ(movie.exit_code, 0) << movie.err;
  EXPECT_THAT(movie.err, HasSubstr("1 of 8 views are outside of what the images enclose"));
  EXPECT_EQ(VideoReader(folder_ / "movie.mp4").frame_count(), 8);
  EXPECT_THAT(view({"--at=-0.1,-0.1", "-o", folder_ / "v.png"}).err,
              HasSubstr("1 of 1 view is outside"));
  EXPECT_THAT(view({"--at=-0.1,-0.1", "-o", folder_ / "v.png", "--quiet"}).err, IsEmpty());
}

TEST_F(SceneCommand, RefusesWrongUsage) {
  const auto refused = [&](const ProcessResult& result, int exit_code, const std::string& command,
                           const std::string& text) {
    EXPECT_EQ(result.exit_code, exit_code) << result.err;
    EXPECT_TRUE(is_one_line(result, command));
    EXPECT_THAT(result.err, HasSubstr(text));
  };
  refused(build({}), 2, "scene build", "expected --images or --positions");
  refused(build({"--images", images_, "--positions", "p.csv"}), 2, "scene build", "both given");
  refused(build({"--positions", "p.csv", "--grid", "2x3"}), 2, "scene build",
          "--grid has no effect with --positions");
  refused(build({"--images", images_, "--grid", "2"}), 2, "scene build", "COLUMNSxROWS");
  refused(build({"--images", images_, "--spacing", "0,1"}), 2, "scene build", "above 0");
  refused(build({"--images", images_, "--grid", "2x2"}), 1, "scene build",
          "6 images, expected 4 for a grid of 2x2");
  refused(build({"--images", folder_ / "nothing"}), 1, "scene build", "nothing");
  refused(build({"--images", images_, "--disparities-y=-1:1"}), 2, "scene build",
          "--disparities-y");
  write_file(folder_ / "list.csv", "images/0.png,0,0\nimages/1.png,1,1\n");
  refused(build({"--positions", folder_ / "list.csv"}), 1, "scene build",
          "0.png at 0,0 has no neighbour");
  refused(view({"--at", "0,0", "-o", folder_ / "v.png"}), 1, "scene view", "there is no scene");
  refused(run_vantage({"scene", "info", place_}), 1, "scene info", "there is no scene");
  EXPECT_EQ(run_vantage({"scene"}).exit_code, 2);

  ASSERT_EQ(build({"--images", images_ + "/[01].png"}).exit_code, 0);
  refused(view({"-o", folder_ / "v.png"}), 2, "scene view", "expected --at X,Y or --sweep");
  refused(view({"--at", "0", "-o", folder_ / "v.png"}), 2, "scene view", "a position X,Y");
  refused(view({"--at", "40,0", "-o", folder_ / "v.png"}), 2, "scene view", "at most 16");
  refused(view({"--sweep", "0,0:1,0:1", "-o", folder_ / "v.mp4"}), 2, "scene view", "VIEWS with 2");
  refused(view({"--at", "0,0", "--at", "1,0", "-o", folder_ / "v.png"}), 2, "scene view",
          "expected a pattern");
  refused(view({"--at", "0,0", "-o", images_ + "/0.png"}), 2, "scene view", "an input as well");
}

}  // namespace
}  // namespace vantage
