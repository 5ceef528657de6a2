// Outputs that are inputs: refused before anything is written, whatever named the input.

#include <set>

#include "apps/commands/commands.h"
#include "tests/apps/sampling.h"

namespace vantage::output_checks_test {

/// A command line and the files that it reads, each by itself.
struct Case {
  Words command;  ///< without --report
  Words inputs;
};

class OutputChecks : public RunTest {
 protected:
  OutputChecks() {
    const std::string calibration =
        "cam0=[60 0 32; 0 60 24; 0 0 1]\ncam1=[60 0 32; 0 60 24; 0 0 1]\ndoffs=0\nbaseline=1\n"
        "width=64\nheight=48\n";
    put("calib.txt", calibration);
    put("tuning.json", "{}");
    put("poses.toml", "[[view]]\nat = [0.5, 0]\n");
    put("path.toml", "[[view]]\nframe = 0\nat = [0, 0]\n[[view]]\nframe = 2\nat = [0.5, 0]\n");
    put("camera.toml",
        "[[view]]\nK = [[60, 0, 32], [0, 60, 24], [0, 0, 1]]\nR = [[1, 0, 0], [0, 1, 0], [0, 0, "
        "1]]\nt = [0, 0, 0]\n");
    put("pairs.csv", "left/000000.png,right/000000.png\n");
    put("places.csv", "left/000000.png,0,0\nright/000000.png,1,0\n");
    put("config.toml", "threads = 2\n");
  }

  void put(const std::string& name, const std::string& text) const {
    write_file(folder_ / name, text);
  }
  [[nodiscard]] std::string at(const std::string& name) const { return folder_ / name; }

  /// Success when `command` is refused and all of the folder is as it was.
  void expect_refused(const Words& command, const std::string& says) const {
    const FolderContent before = results_in(folder_.path());
    expect_failure(run_vantage(command), 2, says);
    EXPECT_TRUE(same_files(results_in(folder_.path()), before)) << command.front();
  }

  [[nodiscard]] std::vector<Case> cases() const {
    const std::string left = at("left/000000.png");
    const std::string right = at("right/000000.png");
    const Words quick = {"--disparities=0:5", "--method", "ssd", "--config", at("config.toml")};
    const auto with = [&](Words words, const Words& more = {}) {
      words = joined(std::move(words), more);
      return joined(std::move(words), quick);
    };
    const Words pair = {left, right, at("config.toml")};
    return {
        {with({"match", left, right, "-o", at("o.pfm"), "--tuning", at("tuning.json")}),
         joined(pair, {at("tuning.json")})},
        {with({"match", left, right, at("left/000001.png"), "--baselines", "1,2", "-o",
               at("o.pfm")}),
         {at("left/000001.png")}},
        {with({"synth", left, right, "--pose", at("poses.toml"), "--calibration", at("calib.txt"),
               "-o", at("v.png")}),
         joined(pair, {at("poses.toml"), at("calib.txt")})},
        {with({"synth", left, right, "--path", at("path.toml"), "-o", at("v%d.png")}),
         {at("path.toml")}},
        {with({"view", left, right, "-o", at("v.html")}), pair},
        {with({"run", "--pairs", at("pairs.csv"), "-o", at("out"), "--calibration", at("calib.txt"),
               "--view", "0.5", "--tuning", at("tuning.json")}),
         joined(pair, {at("pairs.csv"), at("calib.txt"), at("tuning.json")})},
        {with({"run", "--left", at("left"), "--right", at("right/*.png"), "-o", at("out"), "--pose",
               at("poses.toml")}),
         {left, at("right/000007.png"), at("poses.toml")}},
        {with({"run", "--sequence", at("left/%06d.png"), "-o", at("out")}), {left}},
        {{"rectify", at("left/%06d.png"), at("right"), "-o", at("out"), "--calibration",
          at("calib.txt")},
         {left, at("right/000003.png"), at("calib.txt")}},
        {with({"scene", "build", "--positions", at("places.csv"), "-o", at("scene")}),
         joined(pair, {at("places.csv")})},
        {{"eval", left, right, "--views"}, {left, right}},
        {{"reproject", at("map.pfm"), "--depth", at("z.png"), "--calibration", at("calib.txt")},
         {at("map.pfm"), at("calib.txt")}},
        {{"generate", "scene", "-o", at("made"), "--pose", at("camera.toml")}, {at("camera.toml")}},
        {{"book", "pair", "-o", at("made"), "--config", at("config.toml")}, {at("config.toml")}},
        {{"tune", "--size", "64x48", "-o", at("tuning.json"), "--dry-run", "--config",
          at("config.toml")},
         {at("config.toml"), at("tuning.json")}}};
  }
};

TEST_F(OutputChecks, NoReportReplacesAnInput) {
  std::vector<std::pair<Words, std::string>> lines;
  for (const Case& one : cases()) {
    for (const std::string& input : one.inputs) {
      lines.emplace_back(joined(one.command, {"--report", input}), input);
    }
  }
  SCOPED_TRACE(test::sample_name());
  for (const auto& [command, input] : sampled(lines, test_paths::is_sanitized() ? 5 : 20, 31)) {
    const bool is_tuning_output = command.front() == "tune" && input == at("tuning.json");
    expect_refused(command, is_tuning_output ? "--output and --report are the same file"
                                             : "which is also an input");
  }
}

TEST_F(OutputChecks, LinksAreSeenThrough) {
  const Words command = {"run",      "--pairs", at("pairs.csv"),
                         "-o",       at("out"), "--disparities=0:5",
                         "--method", "ssd",     "--trace"};
  fs::create_symlink("pairs.csv", at("symbolic"));
  fs::create_hard_link(at("right/000000.png"), at("hard"));
  fs::create_directory_symlink("left", at("other"));
  for (const std::string name : {"symbolic", "hard", "other/000000.png"}) {
    expect_refused(joined(command, {at(name)}), "which is also an input");
  }
  // Neither is an input that is not there.
  fs::create_symlink("none.png", at("dangling"));
  expect_refused({"match", at("none.png"), at("right/000000.png"), "-o", at("o.pfm"), "--report",
                  at("dangling")},
                 "which is also an input");
}

TEST_F(OutputChecks, ResultsDoNotLandAmongTheFramesOfAList) {
  const Words quick = {"--disparities=0:5", "--method", "ssd", "--save", "preview"};
  fs::create_directories(at("out/preview"));
  fs::copy_file(at("left/000000.png"), at("out/preview/000000.png"));
  put("list.csv", "out/preview/000000.png,right/000000.png\n");
  const std::string says =
      "--output would write into '" + at("out/preview") + "', which contains the input";
  expect_refused(joined({"run", "--pairs", at("list.csv"), "-o", at("out")}, quick), says);
  // By a link to the file, and by one to the folder.
  fs::create_symlink("../out/preview/000000.png", at("left/link.png"));
  put("list.csv", "left/link.png,right/000000.png\n");
  expect_refused(joined({"run", "--pairs", at("list.csv"), "-o", at("out")}, quick), says);
  fs::create_directory(at("more"));
  fs::create_directory_symlink("../right", at("more/preview"));
  expect_refused(
      joined({"run", "--left", at("left"), "--right", at("right"), "-o", at("more")}, quick),
      "would write into '" + at("more/preview") + "'");
  // What goes with the journal.
  succeeds(run(at("begun"), {"--frames", "0-1"}));
  fs::copy_file(at("poses.toml"), at("begun/.vantage/poses.toml"));
  expect_refused(arguments(at("begun"), {"--overwrite", "--pose", at("begun/.vantage/poses.toml")}),
                 "--output would write into");
  expect_refused(arguments(at("begun"), {"--resume", "--report", at("begun/.vantage/run.json")}),
                 "inside the output folder of --output");
  expect_refused({"merge", at("begun"), "--report", at("begun/disparity/000000.pfm")},
                 "inside the output folder of DIR");
}

TEST_F(OutputChecks, RectifiedImagesDoNotReplacePhotographs) {
  fs::copy_file(at("left/000000.png"), at("left.png"));
  expect_refused({"rectify", at("left.png"), at("right/000000.png"), "-o", folder_.path().string()},
                 "--output is '" + at("left.png") + "', which is also an input");
  expect_refused({"rectify", at("left"), at("right"), "-o", folder_.path().string()},
                 "--output would write into");
}

TEST_F(OutputChecks, NothingOfASceneIsReplaced) {
  succeeds(run_vantage({"scene", "build", "--positions", at("places.csv"), "-o", at("scene"),
                        "--disparities=0:5", "--method", "ssd", "--quiet"}));
  for (const std::string name :
       {"scene/scene.json", "left/000000.png", "scene/maps/000-001-first.pfm",
        "scene/maps/000-001-second-unmatched.png"}) {
    expect_refused(
        {"scene", "view", at("scene"), "--at", "0.5,0", "-o", at("v.png"), "--report", at(name)},
        "which is also an input");
  }
  put("scene/maps/list.csv", read_file(at("places.csv")));
  expect_refused({"scene", "build", "--positions", at("scene/maps/list.csv"), "-o", at("scene")},
                 "--output would write into");
}

/// Folders are named for what a command makes in them: what is there by chance is not replaced.
TEST_F(OutputChecks, FilesInFoldersAreNotReplacedUnasked) {
  struct Folder {
    Words command;
    Words made;  ///< each is refused when it is there
  };
  const std::string out = at("out");
  const Words small = words("--width 32 --height 24 --quiet");
  const std::vector<Folder> folders = {
      {joined({"generate", "scene", "-o", out}, small),
       {"left.png", "right-occluded.png", "calib.txt"}},
      {joined({"generate", "scene", "-o", out, "--frames", "2"}, small),
       {"left/000001.png", "right-disparity/000000.pfm"}},
      {joined({"book", "pair", "-o", out}, small), {"left-disparity.pfm"}},
      {words("book figure 3.4 --size 32 --quiet -o " + out), {"figures.html", "figure-3.4.svg"}},
      {words("rectify --calibration " + at("calib.txt") + " --quiet -o " + out + " " + left_ + " " +
             right_),
       {"left/000003.png"}},
      {words("scene build --disparities=0:5 --quiet --positions " + at("places.csv") + " -o " +
             out),
       {"maps/000-001-first.pfm"}},
  };
  for (const Folder& folder : folders) {
    SCOPED_TRACE(folder.command[0] + " " + folder.command[1]);
    for (const std::string& name : folder.made) {
      fs::create_directories((out + "/" + name).substr(0, (out + "/" + name).rfind('/')));
      write_file(out + "/" + name, "mine");
      const ProcessResult refused = run_vantage(folder.command);
      EXPECT_EQ(refused.exit_code, 1);
      EXPECT_THAT(refused.err, HasSubstr(name + " is there, expected a folder without such files; "
                                                "--overwrite replaces them"));
      EXPECT_EQ(files_below(out), Words{name});
      EXPECT_EQ(read_file(out + "/" + name), "mine");
      succeeds(run_vantage(joined(folder.command, {"--overwrite"})));
      fs::remove_all(out);
    }
  }
  // Figures join those of another time.
  succeeds(run_vantage(folders[3].command));
  succeeds(run_vantage(folders[3].command));
}

}  // namespace vantage::output_checks_test
