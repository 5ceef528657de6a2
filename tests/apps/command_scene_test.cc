#include <chrono>
#include <csignal>
#include <fstream>
#include <thread>

#include "engine/evaluation/view_evaluation.h"
#include "engine/generation/layered_scene.h"
#include "engine/io/video/video_io.h"
#include "engine/rectification/rows/row_correction.h"
#include "tests/apps/sampling.h"
#include "tests/engine/unrectified_pair.h"

namespace vantage::command_scene_test {

/// A grid of 3 by 2 cameras, half a baseline apart, in DIR/images.
class SceneCommand : public testing::Test {
 protected:
  static LayeredSceneOptions small_scene() {
    return {.width_px = 106, .height_px = 74, .samples_per_side = 2};
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
  [[nodiscard]] ProcessResult build(const Words& more) const {
    return run_vantage(joined(
        {"scene", "build", "-o", place_, "--disparities=0:8", "--preset", "balanced"}, more));
  }
  [[nodiscard]] ProcessResult build_grid(const Words& more = {}) const {
    return build(joined({"--images", images_, "--grid", "3x2", "--spacing", "0.5,0.5"}, more));
  }
  [[nodiscard]] ProcessResult view(const Words& more) const {
    return run_vantage(joined({"scene", "view", place_}, more));
  }

  mutable Execution execution_{{.threads = 2}};
  LayeredScene scene_{small_scene(), execution_};
  TemporaryFolder folder_;
  std::string images_ = folder_ / "images";
  std::string place_ = folder_ / "scene";
};

TEST_F(SceneCommand, BuildsAGridAndRendersViewsOfIt) {
  const ProcessResult built = succeeds(build_grid({"--report", folder_ / "build.json"}));
  EXPECT_THAT(built.err, HasSubstr("6 images, 7 edges, 7 of them matched now"));
  const nlohmann::json build_report = read_json(folder_ / "build.json");
  EXPECT_EQ(build_report.at("results").at("triangles"), 4);
  EXPECT_EQ(build_report.at("results").at("edges_matched").size(), 7U);
  EXPECT_GT(build_report.at("cells"), 0);
  EXPECT_EQ(build_report.at("settings").at("grid"), "3x2");

  const ProcessResult seen =
      succeeds(view({"--at", "0.3,0.2", "--at=0.75,0", "-o", folder_ / "v%d.png", "--hole-mask",
                     folder_ / "h%d.png", "--report", folder_ / "view.json"}));
  EXPECT_THAT(seen.err, Not(HasSubstr("outside")));
  EXPECT_GE(psnr(folder_ / "v0.png", 0.3, 0.2), 29);
  EXPECT_GE(psnr(folder_ / "v1.png", 0.75, 0), 29);
  EXPECT_TRUE(fs::exists(folder_ / "h1.png"));
  const nlohmann::json views = read_json(folder_ / "view.json").at("results").at("views");
  ASSERT_EQ(views.size(), 2U);
  EXPECT_EQ(views[0].at("from").size(), 3U);
  EXPECT_EQ(views[0].at("x"), 0.3);

  // Where a camera stood its photograph comes back.
  succeeds(view({"--at", "1,0.5", "-o", folder_ / "same.png"}));
  EXPECT_EQ(read_file(folder_ / "same.png"), read_file(images_ + "/5.png"));

  const ProcessResult info = succeeds(run_vantage({"scene", "info", place_}));
  EXPECT_THAT(info.out, AllOf(HasSubstr("images 6, 106x74 pixels"), HasSubstr("../images/4.png"),
                              HasSubstr("edges 7, 7 of them matched"),
                              HasSubstr("1-4 along y, length 0.5, disparities 0:8, matched 9"),
                              HasSubstr("triangles 4")));
}

TEST_F(SceneCommand, MakesMoviesAndSaysWhatLiesOutside) {
  succeeds(build_grid({"--quiet"}));
  const ProcessResult movie =
      succeeds(view({"--sweep", "0,0:1.1,0.5:8", "--fps", "8", "-o", folder_ / "movie.mp4"}));
  EXPECT_THAT(movie.err, HasSubstr("1 of 8 views are outside the area of the images"));
  EXPECT_EQ(VideoReader(folder_ / "movie.mp4").frame_count(), 8);
  EXPECT_THAT(view({"--at=-0.1,-0.1", "-o", folder_ / "v.png"}).err,
              HasSubstr("1 of 1 view is outside"));
  EXPECT_THAT(view({"--at=-0.1,-0.1", "-o", folder_ / "v.png", "--quiet"}).err, IsEmpty());
}

TEST_F(SceneCommand, RendersPathsAndTwoEyes) {
  succeeds(build_grid({"--quiet"}));
  write_file(folder_ / "path.toml",
             "[[view]]\nframe = 0\nat = [0.0, 0.0]\n[[view]]\nframe = 4\nat = [0.8, 0.4]\n"
             "[[view]]\nframe = 6\nat = [0.8, 0.0]\n");
  const ProcessResult path =
      succeeds(view({"--path", folder_ / "path.toml", "-o", folder_ / "p%d.png", "--source-mask",
                     folder_ / "s%d.png"}));
  EXPECT_THAT(path.err, HasSubstr("7 views"));
  succeeds(view({"--at", "0.6,0.3", "-o", folder_ / "one.png"}));
  EXPECT_EQ(read_file(folder_ / "one.png"), read_file(folder_ / "p3.png"));
  EXPECT_FALSE(fs::exists(folder_ / "p7.png"));
  EXPECT_TRUE(fs::exists(folder_ / "s6.png"));

  // The eyes of one view are in two triangles; distances count lengths of the shortest edge.
  const ProcessResult eyes =
      succeeds(view({"--at", "0.5,0.2", "--stereo-packing", "sbsl", "--eye-separation", "0.4", "-o",
                     folder_ / "eyes.png", "--report", folder_ / "eyes.json"}));
  EXPECT_THAT(eyes.err, HasSubstr("212x74 pixels, 1 view "));
  succeeds(view({"--at", "0.4,0.2", "-o", folder_ / "left.png"}));
  const Photograph both = read_photograph(folder_ / "eyes.png");
  const Photograph left = read_photograph(folder_ / "left.png");
  for (int y = 0; y < 74; ++y) {
    for (int i = 0; i < 106 * 3; ++i) {
      ASSERT_EQ(std::get<Mask>(both.pixels).row(y)[i], std::get<Mask>(left.pixels).row(y)[i]);
    }
  }
  const nlohmann::json described =
      read_json(folder_ / "eyes.json").at("results").at("views").at(0).at("eyes");
  EXPECT_EQ(described.at(0).at("x"), 0.4);
  EXPECT_EQ(described.at(1).at("x"), 0.6);
}

TEST_F(SceneCommand, AKilledBuildGoesOnWhereItStopped) {
  const auto contents = [&] {
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator(place_)) {
      if (entry.is_regular_file()) {
        files[entry.path().lexically_relative(place_).string()] = read_file(entry.path().string());
      }
    }
    return files;
  };
  succeeds(build_grid());
  const auto complete = contents();
  for (const int signal : {SIGKILL, SIGINT}) {
    fs::remove_all(place_);
    const VantageProcess process(
        {"scene", "build", "-o", place_, "--disparities=0:8", "--preset", "balanced", "--images",
         images_, "--grid", "3x2", "--spacing", "0.5,0.5"},
        folder_.path());
    while (!fs::exists(place_ + "/maps/000-001-first.pfm") && !process.has_ended()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    process.send(signal);
    const ProcessResult ended = process.wait();
    if (signal == SIGINT && ended.exit_code != 0) {  // 0: it was too late
      EXPECT_EQ(ended.exit_code, 130);
      EXPECT_THAT(ended.err, HasSubstr("run the same command to continue"));
    }
    succeeds(build_grid());
    EXPECT_EQ(contents(), complete) << signal;
  }
}

TEST_F(SceneCommand, SaysWhichImagesHaveGone) {
  succeeds(build_grid());
  fs::rename(images_, folder_ / "elsewhere");
  const ProcessResult lost = view({"--at", "0.3,0.2", "-o", folder_ / "v.png"});
  expect_one_line(lost, 1, "scene view");
  EXPECT_THAT(lost.err, AllOf(HasSubstr("images/0.png is missing"), HasSubstr("--copy-images")));
  EXPECT_FALSE(fs::exists(folder_ / "v.png"));
  images_ = folder_ / "elsewhere";
  EXPECT_THAT(build_grid().err, HasSubstr("0 of them matched now"));
  succeeds(view({"--at", "0.3,0.2", "-o", folder_ / "v.png"}));
}

using InputSceneCommand = SceneCommand;

TEST_F(InputSceneCommand, AnImageThatCannotBeReadStopsTheBuildBeforeItBegins) {
  write_file(images_ + "/3.png", read_file(images_ + "/3.png").substr(0, 900));
  expect_one_line(build_grid(), 1, "scene build", "3.png");
  EXPECT_FALSE(fs::exists(place_ + "/scene.json"));
}

// Rows and columns of a scene whose positions are wrong.
TEST_F(SceneCommand, WarnsOfEdgesThatDoNotCorrespond) {
  const LayeredScene scene({.width_px = 320, .height_px = 240, .samples_per_side = 1}, execution_);
  const std::vector<SceneView> places = {{0, 0}, {0.5, 0}, {0, 0.5}, {0.5, 0.6}};
  for (std::size_t i = 0; i < places.size(); ++i) {
    write_photograph(folder_ / std::to_string(i) + ".png", scene.render(places[i], 0).image);
  }
  write_file(folder_ / "list.csv", "0.png,0,0\n1.png,1,0\n2.png,0,1\n3.png,1,1\n");
  const auto build_with = [&](const Words& more) {
    fs::remove_all(place_);
    return build(joined({"--positions", folder_ / "list.csv"}, more));
  };
  const ProcessResult built =
      succeeds(build_with({"--rows", "as-is", "--report", folder_ / "report.json"}));
  EXPECT_THAT(built.err, AllOf(HasSubstr("warning: edge 2-3 (2.png, 3.png): rows are off by"),
                               Not(HasSubstr("edge 0-1")), Not(HasSubstr("exchanged"))));
  const nlohmann::json edges = read_json(folder_ / "report.json").at("results").at("edges_matched");
  EXPECT_EQ(edges.at(0).at("rectification").at("is_rectified"), true);
  EXPECT_EQ(edges.at(3).at("rectification").at("is_rectified"), false);
  EXPECT_THAT(build_with({"--no-rectification-check"}).err, Not(HasSubstr("warning")));
  EXPECT_THAT(build_with({"--quiet"}).err, IsEmpty());

  write_file(folder_ / "list.csv", "1.png,0,0\n0.png,1,0\n");
  EXPECT_THAT(build_with({}).err,
              HasSubstr("warning: edge 0-1 (1.png, 0.png): the images look exchanged: "));
}

// The first, then the second of three photographs shows everything lower, and turned.
TEST_F(SceneCommand, CorrectsTheRowsOfTheImageThatDiffers) {
  const LayeredScene scene({.width_px = 320, .height_px = 240, .samples_per_side = 1}, execution_);
  for (int wrong = 0; wrong < 2; ++wrong) {
    fs::remove_all(place_);
    for (int i = 0; i < 3; ++i) {
      const Photograph image = scene.render(SceneView{0.5 * i, 0}, 0).image;
      Photograph lower;
      correct_rows(image, RowField(320, 240, {-1.4, -0.2}), lower, execution_);
      write_photograph(folder_ / std::to_string(i) + ".png", i == wrong ? lower : image);
    }
    const Words images = {"--images", folder_ / "?.png", "--spacing", "0.5,1"};
    EXPECT_THAT(build(joined(images, {"--rows", "as-is"})).err,
                AnyOf(HasSubstr("rows are off by"), HasSubstr("not a rectified pair")));
    const ProcessResult built =
        succeeds(build(joined(images, {"--report", folder_ / "report.json"})));
    EXPECT_THAT(built.err,
                AllOf(HasSubstr("rows: " + std::to_string(wrong) + ".png 1."),
                      HasSubstr(" px lower"), HasSubstr("corrected"), Not(HasSubstr("warning"))));
    const nlohmann::json rows = read_json(folder_ / "report.json").at("results").at("rows");
    ASSERT_EQ(rows.size(), 1U);
    EXPECT_EQ(rows.at(0).at("image"), wrong);
    EXPECT_NEAR(rows.at(0).at("offset_px").get<double>(), 1.4, 0.1);
    EXPECT_THAT(build(images).err, HasSubstr("0 of them matched now"));
    succeeds(view({"--at", "0.25,0", "-o", folder_ / "view.png"}));
    const Photograph truth = scene.render(SceneView{0.25, 0}, 0).image;
    EXPECT_GE(evaluate_view(read_photograph(folder_ / "view.png"), truth, execution_).psnr_db,
              28.5);
  }
}

TEST_F(SceneCommand, RefusesHandHeldCamerasUnlessForced) {
  const test::RenderedPair pair = test::unrectified_pair(execution_);
  write_photograph(folder_ / "a.png", pair.left);
  write_photograph(folder_ / "b.png", pair.right);
  write_file(folder_ / "list.csv", "a.png,0,0\nb.png,1,0\n");
  const Words turned = {"--positions", folder_ / "list.csv"};
  const ProcessResult refused = build(turned);
  expect_one_line(refused, 1, "scene build");
  EXPECT_THAT(refused.err,
              AllOf(HasSubstr("a.png and "),
                    HasSubstr("b.png: not a rectified pair: rows are off "
                              "by "),
                    HasSubstr("expected at most 1.5 px"), HasSubstr("'vantage rectify'"),
                    HasSubstr("--no-rectification-check")));
  EXPECT_TRUE(fs::is_empty(place_ + "/maps"));
  EXPECT_THAT(view({"--at", "0.5,0", "-o", folder_ / "v.png"}).err,
              HasSubstr("1 of 1 edges are not matched yet"));
  succeeds(build(joined(turned, {"--no-rectification-check"})));

  // What the message suggests.
  fs::remove_all(place_);
  succeeds(
      run_vantage({"rectify", folder_ / "a.png", folder_ / "b.png", "-o", folder_ / "rectified"}));
  succeeds(build({"--images", folder_ / "rectified/*.png"}));
}

TEST_F(SceneCommand, RefusesImagesOfWhichLittleMatches) {
  const ProcessResult refused =
      run_vantage({"scene", "build", "--images", images_ + "/[01].png", "-o", place_,
                   "--disparities=40:60", "--preset", "balanced"});
  expect_one_line(refused, 1, "scene build");
  EXPECT_THAT(refused.err, AllOf(HasSubstr("1.png: "),
                                 HasSubstr("% of the pixels match, expected at least 30 %"),
                                 HasSubstr("--disparities (40:60 was searched)")));
  EXPECT_TRUE(fs::is_empty(place_ + "/maps"));
}

TEST_F(InputSceneCommand, RefusesWrongUsage) {
  write_file(folder_ / "alone.csv", "images/0.png,0,0\n");
  write_file(folder_ / "twice.csv", "images/0.png,0,0\nimages/1.png,0,0\n");
  const std::vector<Refusal> of_build = {
      {{}, "expected --images or --positions"},
      {{"--images", images_, "--positions", "p.csv"}, "both given"},
      {{"--positions", "p.csv", "--grid", "2x3"}, "--grid has no effect with --positions"},
      {{"--images", images_, "--grid", "2"}, "COLUMNSxROWS"},
      {{"--images", images_, "--spacing", "0,1"}, "above 0"},
      {{"--images", images_, "--grid", "2x2"}, "6 images, expected 4 for a grid of 2x2", 1},
      {{"--images", folder_ / "nothing"}, "nothing", 1},
      {{"--images", images_, "--disparities-y=-1:1"}, "disparities-y is set"},
      {{"--positions", folder_ / "alone.csv"}, "scene has 1 images, expected 2 to 4096", 1},
      {{"--positions", folder_ / "twice.csv"}, "1.png at 0,0 has the same position as", 1}};
  expect_refusals("scene build", folder_.path(), of_build,
                  [&](const Words& more) { return build(more); });
  const std::string out = folder_ / "v.png";
  expect_one_line(view({"--at", "0,0", "-o", out}), 1, "scene view", "no scene");
  expect_one_line(run_vantage({"scene", "info", place_}), 1, "scene info", "no scene");
  EXPECT_EQ(run_vantage({"scene"}).exit_code, 2);

  succeeds(build({"--images", images_ + "/[01].png"}));
  write_file(folder_ / "cameras.toml",
             "[[view]]\nframe = 0\nK = [9,0,5, 0,9,5, 0,0,1]\nR = [1,0,0, 0,1,0, 0,0,1]\n"
             "t = [0,0,0]\n");
  const std::vector<Refusal> of_view = {
      {{"-o", out}, "expected one of --at, --sweep and --path"},
      {{"--at", "0", "-o", out}, "a position X,Y"},
      {{"--at", "40,0", "-o", out}, "at most 16"},
      {{"--sweep", "0,0:1,0:1", "-o", folder_ / "v.mp4"}, "VIEWS with 2"},
      {{"--at", "0,0", "--at", "1,0", "-o", out}, "expected a pattern"},
      {{"--at", "0,0", "-o", images_ + "/0.png"}, "also an input"},
      {{"--sweep", "0,0:90,0:4", "-o", folder_ / "v%d.png"},
       "view at 30,0 is 29 lengths of the nearest edge away from its images, expected at most 16"},
      {{"--at", "0,0", "--sweep", "0,0:1,0:4", "-o", folder_ / "v.mp4"},
       "expected one of --at, --sweep and --path"},
      {{"--at", "0,0", "--eye-separation", "2", "-o", out}, "no effect without --stereo-packing"},
      {{"--at", "0,0", "--stereo-packing", "sbsl", "--hole-mask", folder_ / "h.png", "-o", out},
       "--hole-mask is the mask of one view"},
      {{"--path", folder_ / "cameras.toml", "-o", folder_ / "v.mp4"},
       "expected positions at = [X, Y] among the images"}};
  expect_refusals("scene view", folder_.path(), of_view,
                  [&](const Words& more) { return view(more); });
}

}  // namespace vantage::command_scene_test
