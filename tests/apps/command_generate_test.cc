#include "tests/apps/pair_fixture.h"

namespace vantage::command_generate_test {

TEST(GenerateCommand, BookPairsWithTruth) {
  const TemporaryFolder folder;
  for (const std::string_view name : kBookPairNames) {
    const std::string out = folder / std::string(name);
    succeeds(run_vantage({"book", "pair", "--pattern", std::string(name), "-o", out}));
    EXPECT_THAT(files_below(out),
                ElementsAre("left-disparity.pfm", "left-occluded.png", "left.png",
                            "right-disparity.pfm", "right-occluded.png", "right.png"));
    const BookPair pair = make_book_pair(book_pair_options(name));
    const DisparityMap truth = read_disparity(out + "/left-disparity.pfm");
    ASSERT_EQ(truth.width(), pair.left_disparity.width());
    for (int x = 0; x < truth.width(); ++x) {
      EXPECT_EQ(truth.at(x, 50), pair.left_disparity.at(x, 50)) << name << ' ' << x;
    }
  }
}

TEST(GenerateCommand, NoiseGivesFloatImagesThatMatchReads) {
  const TemporaryFolder folder;
  const std::string out = folder / "noisy";
  succeeds(run_vantage({"book", "pair", "--noise", "2", "--width", "40", "-o", out}));
  succeeds(run_vantage({"match", out + "/left.pfm", out + "/right.pfm", "-o", folder / "map.pfm",
                        "--disparities=0:9"}));
}

TEST(GenerateCommand, ScenesAsPairsAndSequences) {
  const TemporaryFolder folder;
  const Words scene =
      words("generate scene --width 33 --height 21 --samples 1 --view 0.5 --view -1");
  const Words single = joined(scene, {"-o", folder / "single"});
  ProcessResult result = succeeds(run_vantage(single));
  EXPECT_THAT(result.err, HasSubstr("--disparities="));
  EXPECT_THAT(files_below(folder / "single"),
              ElementsAre("calib.txt", "left-disparity.pfm", "left-occluded.png", "left.png",
                          "right-disparity.pfm", "right-occluded.png", "right.png", "view--1.png",
                          "view-0.5.png"));

  const Words sequence = joined(scene, {"--frames", "3", "-o", folder / "sequence"});
  result = succeeds(run_vantage(sequence));
  EXPECT_EQ(files_below(folder / "sequence").size(), 3U * 8 + 1);
  EXPECT_EQ(read_file(folder / "sequence/left/000000.png"), read_file(folder / "single/left.png"));
  EXPECT_EQ(read_file(folder / "sequence/views/0.5/000000.png"),
            read_file(folder / "single/view-0.5.png"));
  EXPECT_NE(read_file(folder / "sequence/left/000002.png"),
            read_file(folder / "sequence/left/000000.png"));
  // What it writes is what the other commands read.
  result =
      succeeds(run_vantage({"run", "--left", folder / "sequence/left", "--right",
                            folder / "sequence/right", "-o", folder / "out", "--disparities=0:3"}));
}

TEST(GenerateCommand, BoardsHaveMasks) {
  const TemporaryFolder folder;
  succeeds(run_vantage({"generate", "scene", "--boards", "--width", "64", "--height", "48",
                        "--samples", "1", "-o", folder / "boards"}));
  EXPECT_THAT(files_below(folder / "boards"),
              ElementsAre("calib.txt", "left-disparity.pfm", "left-occluded.png",
                          "left-uniform.png", "left.png", "right-disparity.pfm",
                          "right-occluded.png", "right-uniform.png", "right.png"));
  // `eval --mask` reads them: a map has no error where it is compared with itself.
  succeeds(run_vantage({"eval", folder / "boards/left-disparity.pfm",
                        folder / "boards/left-disparity.pfm", "--mask",
                        folder / "boards/left-uniform.png"}));
}

// Cameras like the pair's see what views on and off its baseline see.
TEST(GenerateCommand, AnyCameraLooksAtTheScene) {
  const TemporaryFolder folder;
  write_file(folder / "cameras.toml",
             "[[view]]\nK = [33, 0, 16, 0, 33, 10, 0, 0, 1]\n"
             "R = [1, 0, 0, 0, 1, 0, 0, 0, 1]\nt = [-0.5, 0.25, 0]\n"
             "[[view]]\nK = [33, 0, 16, 0, 33, 10, 0, 0, 1]\n"
             "R = [1, 0, 0, 0, 1, 0, 0, 0, 1]\nt = [0, 0, 0.1]\nsize = [20, 11]\n");
  succeeds(run_vantage({"generate", "scene", "--width", "33", "--height", "21", "--samples", "1",
                        "--view", "0.5,-0.25", "--pose", folder / "cameras.toml", "-o",
                        folder / "scene", "--quiet"}));
  EXPECT_EQ(read_file(folder / "scene/camera-0.png"),
            read_file(folder / "scene/view-0.5,-0.25.png"));
  EXPECT_EQ(read_photograph(folder / "scene/camera-1.png").width(), 20);
  // What it writes is what other commands read.
  succeeds(run_vantage({"synth", folder / "scene/left.png", folder / "scene/right.png",
                        "--left-disparity", folder / "scene/left-disparity.pfm",
                        "--right-disparity", folder / "scene/right-disparity.pfm", "--calibration",
                        folder / "scene/calib.txt", "--pose", folder / "cameras.toml", "-o",
                        folder / "v%d.png", "--quiet"}));
}

TEST(InputGenerateCommand, WrongUsageIsOneLineAndExit2) {
  const TemporaryFolder folder;
  const std::vector<Words> misuses = {
      {"book", "pair", "-o", folder / "o", "--pattern", "stripes"},
      {"book", "pair", "-o", folder / "o", "--width", "0"},
      {"book", "pair", "-o", folder / "o", "--seed", "-1"},
      {"book", "pair"},
      {"generate", "scene", "-o", folder / "o", "--frames", "0"},
      {"generate", "scene", "-o", folder / "o", "--view", "99"},
      {"generate", "scene", "-o", folder / "o", "--near", "1", "--far", "2"}};
  for (const auto& misuse : misuses) {
    const ProcessResult result = run_vantage(misuse);
    EXPECT_EQ(result.exit_code, 2) << misuse.back();
    EXPECT_TRUE(is_one_line(result, misuse[0] + " " + misuse[1]));
  }
  EXPECT_THAT(files_below(folder.path()), IsEmpty());
}

TEST(SlowInfoCommand, TellsTheVersionAndTheInstructionSets) {
  const ProcessResult table = succeeds(run_vantage({"info"}));
  EXPECT_THAT(table.out, HasSubstr("instruction sets"));
  const auto info = nlohmann::json::parse(run_vantage({"info", "--json"}).out);
  EXPECT_GE(info["isa_built"].size(), info["isa_available"].size());
  EXPECT_EQ(info["isa"], info["isa_available"][0]);
  EXPECT_GE(info["hardware_threads"], 1);
}

}  // namespace vantage::command_generate_test
