#include <cstring>
#include <fstream>
#include <variant>

#include "engine/generation/layered_scene.h"
#include "engine/image/transposed.h"
#include "tests/apps/sampling.h"

namespace vantage::automatic_disparities_test {

/// "MIN:MAX" of a report.
std::pair<int, int> limits_of(const std::string& range) {
  std::pair<int, int> limits;
  EXPECT_EQ(std::sscanf(range.c_str(), "%d:%d", &limits.first, &limits.second), 2) << range;
  return limits;
}

/// match, synth and run choose the range themselves.
class AutomaticDisparities : public PairTest {
 protected:
  static BookPairOptions small_square() {
    BookPairOptions options = book_pair_options("real-square");
    options.width_px = 160;
    options.height_px = 120;
    return options;
  }
  AutomaticDisparities() {
    pair_ = make_book_pair(small_square());
    write_photograph(left_, pair_.left);
    write_photograph(right_, pair_.right);
  }
};

TEST_F(AutomaticDisparities, MatchTellsTheRangeAndReportsIt) {
  const ProcessResult result =
      succeeds(run_vantage({"match", left_, right_, "-o", folder_ / "a.pfm", "--disparities",
                            "auto", "--report", folder_ / "r.json"}));
  const auto report = read_json(folder_ / "r.json");
  const std::string range = report["settings"]["disparities"];
  EXPECT_THAT(result.err, HasSubstr("--disparities auto is " + range));
  EXPECT_TRUE(report["seconds"]["stages"].contains("range"));
  const auto [min, max] = limits_of(range);
  EXPECT_LE(min, 2);
  EXPECT_GE(max, 6);
  EXPECT_LE(max - min, 20);
  // The same as giving that range.
  succeeds(
      run_vantage({"match", left_, right_, "-o", folder_ / "b.pfm", "--disparities=" + range}));
  EXPECT_EQ(read_file(folder_ / "a.pfm"), read_file(folder_ / "b.pfm"));
  EXPECT_LT(bad_share(read_disparity(folder_ / "a.pfm"), pair_.left_disparity, pair_.left_occluded),
            0.05);
}

TEST_F(AutomaticDisparities, SynthAndRunTakeItToo) {
  ProcessResult result = succeeds(run_vantage(
      {"synth", left_, right_, "-o", folder_ / "v.png", "--view", "0.5", "--disparities=auto"}));
  EXPECT_THAT(result.err, HasSubstr("synth: --disparities auto is "));
  result = succeeds(
      run_vantage({"run", "--left", left_, "--right", right_, "-o", folder_ / "out",
                   "--disparities", "auto", "--progress", "bar", "--report", folder_ / "r.json"}));
  EXPECT_THAT(result.err, HasSubstr("run: range: [========================] 1/1 pairs"));
  EXPECT_THAT(result.err, HasSubstr("run: --disparities auto is "));
  EXPECT_NE(read_json(folder_ / "r.json")["settings"]["disparities"], "auto");
}

TEST_F(AutomaticDisparities, ConstantImagesNeedARange) {
  write_grey(folder_ / "grey.png", 80, 60, 77);
  const std::string grey_file = folder_ / "grey.png";
  for (const Words& command :
       {Words{"match", grey_file, grey_file, "-o", folder_ / "o.pfm"},
        {"run", "--left", grey_file, "--right", grey_file, "-o", folder_ / "out"}}) {
    const ProcessResult result = run_vantage(joined(command, {"--disparities", "auto"}));
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_TRUE(is_one_line(result, command.front()));
    EXPECT_THAT(result.err, HasSubstr("give --disparities MIN:MAX"));
  }
  EXPECT_FALSE(fs::exists(std::string(folder_ / "o.pfm")));
}

TEST_F(AutomaticDisparities, IsWhatCommandsDoUnlessARangeIsGiven) {
  for (const Words& command :
       {Words{"match", left_, right_, "-o", folder_ / "d.png"},
        {"synth", left_, right_, "--view", "0.5", "-o", folder_ / "d.png"},
        {"view", left_, right_, "-o", folder_ / "d.html"},
        {"run", "--left", left_, "--right", right_, "--format", "png", "-o", folder_ / "run"}}) {
    const ProcessResult result = succeeds(run_vantage(command));
    EXPECT_THAT(result.err, HasSubstr(command.front() + ": --disparities auto is 0:"));
  }
  std::ofstream(folder_ / "places.csv") << "left.png,0,0\nright.png,1,0\n";
  succeeds(run_vantage({"scene", "build", "--positions", folder_ / "places.csv", "-o",
                        folder_ / "scene", "--report", folder_ / "scene.json"}));
  const auto report = read_json(folder_ / "scene.json");
  EXPECT_THAT(report["results"]["edges_matched"][0]["disparities"].get<std::string>(),
              StartsWith("0:"));
}

TEST_F(AutomaticDisparities, ExchangedImagesAreToldAndNoPngIsBegun) {
  const ProcessResult map = succeeds(run_vantage(
      {"match", right_, left_, "-o", folder_ / "d.pfm", "--report", folder_ / "r.json"}));
  EXPECT_THAT(map.err, HasSubstr("mostly negative: the images look exchanged"));
  const auto report = read_json(folder_ / "r.json");
  if (report["results"].contains("rectification")) {  // points enough to tell
    EXPECT_TRUE(report["results"]["rectification"]["looks_exchanged"].get<bool>());
  }
  for (const Words& command :
       {Words{"match", right_, left_, "-o", folder_ / "d.png"},
        {"run", "--left", right_, "--right", left_, "--format", "png", "-o", folder_ / "run"}}) {
    const ProcessResult png = run_vantage(command);
    EXPECT_EQ(png.exit_code, 2);
    EXPECT_THAT(png.err, AllOf(HasSubstr("16-bit PNG, which holds disparities from 0"),
                               HasSubstr("expected .pfm, .tiff, .exr or .npy"),
                               HasSubstr("look exchanged")));
  }
  EXPECT_FALSE(fs::exists(std::string(folder_ / "d.png")));
  EXPECT_FALSE(fs::exists(std::string(folder_ / "run")));
}

TEST_F(AutomaticDisparities, ARunFindsItInAllOfTheInput) {
  // The second pair is far nearer, the third cannot be read.
  BookPairOptions near = small_square();
  near.background_disparity_px = 30;
  near.front_disparity_px = 36;
  const BookPair second = make_book_pair(near);
  write_photograph(folder_ / "l2.png", second.left);
  write_photograph(folder_ / "r2.png", second.right);
  std::ofstream(folder_ / "bad.png") << "no picture";
  std::ofstream(folder_ / "pairs.csv")
      << "bad.png,bad.png\nleft.png,right.png\nl2.png,r2.png\nbad.png,bad.png\n";
  std::string ranges[2];
  for (const int part : {0, 1}) {
    // Parts of one folder must agree, whichever pairs are theirs.
    const ProcessResult result =
        run_vantage({"run", "--pairs", folder_ / "pairs.csv", "--keep-going", "--chunk-frames", "1",
                     "--shard", std::to_string(part + 1) + "/2", "--threads",
                     std::to_string(part + 1), "-o", folder_ / "run"});
    EXPECT_EQ(result.exit_code, 3) << result.err;
    ranges[part] = read_json(folder_ / "run/.vantage/run.json")["settings"]["disparities"];
  }
  EXPECT_EQ(ranges[0], ranges[1]);
  const auto [min, max] = limits_of(ranges[0]);
  EXPECT_LE(min, 2);
  EXPECT_GE(max, 36);
}

TEST_F(AutomaticDisparities, AResumedRunTakesTheRangeThatItBeganWith) {
  const std::string left = folder_ / "left.pgm";
  const std::string right = folder_ / "right.pgm";
  write_photograph(left, pair_.left);
  write_photograph(right, pair_.right);
  std::ofstream(folder_ / "pairs.csv") << left << ',' << right << '\n';
  const Words command = {"run", "--pairs", folder_ / "pairs.csv", "-o", folder_ / "run"};
  succeeds(run_vantage(command));
  // Nothing is read to find it: these images, which look unchanged, have none.
  for (const std::string& file : {left, right}) {
    const auto time = fs::last_write_time(file);
    write_grey(file, 160, 120, 99);
    fs::last_write_time(file, time);
  }
  const ProcessResult resumed = succeeds(run_vantage(joined(command, {"--resume"})));
  EXPECT_THAT(resumed.err, HasSubstr("run: --disparities auto is 0:"));
}

TEST_F(AutomaticDisparities, ACutRangeIsToldOf) {
  Execution execution({.threads = 2});
  const LayeredScene scene({.width_px = 240,
                            .height_px = 150,
                            .far_disparity_px = 5,
                            .near_disparity_px = 25,
                            .samples_per_side = 1},
                           execution);
  for (const char* folder : {"l", "r"}) {
    fs::create_directory(folder_ / folder);
  }
  for (const char* name : {"0.png", "1.png"}) {
    write_photograph(folder_ / ("l/" + std::string(name)), scene.render({0, 0}, 0).image);
    write_photograph(folder_ / ("r/" + std::string(name)), scene.render({1, 0}, 0).image);
  }
  const Words match = {"match",           folder_ / "l/0.png", folder_ / "r/0.png", "-o",
                       folder_ / "m.pfm", "--report",          folder_ / "r.json"};
  const Words run = {"run",      "--left",           folder_ / "l", "--right",       folder_ / "r",
                     "--report", folder_ / "r.json", "-o",          folder_ / "run", "--overwrite"};
  const Words synth = {"synth", folder_ / "l/0.png", folder_ / "r/0.png", "--view",          "0.5",
                       "-o",    folder_ / "v.png",   "--report",          folder_ / "r.json"};
  for (Words command : {match, run, synth}) {
    const ProcessResult whole = succeeds(run_vantage(command));
    EXPECT_THAT(whole.err, Not(HasSubstr("left out")));
    command = joined(command, {"--disparities", "0:10"});
    const ProcessResult cut = succeeds(run_vantage(command));
    EXPECT_THAT(cut.err, HasSubstr("disparities above 10 seem to be left out"));
    EXPECT_EQ(cut.err.find("left out"), cut.err.rfind("left out")) << cut.err;
    const auto results = read_json(folder_ / "r.json")["results"];
    EXPECT_TRUE(results["cut_range"]["above"].get<bool>());
    EXPECT_FALSE(results["cut_range"]["below"].get<bool>());
    EXPECT_EQ(run_vantage(joined(command, {"--quiet"})).err, "");
  }
}

/// Share of the pixels away from the borders whose displacement is within half a pixel of (x, y).
double share_at(const std::string& flo, int width, int height, float x, float y) {
  const std::string bytes = read_file(flo);
  constexpr std::size_t kHeader = 12;
  EXPECT_EQ(bytes.size(), kHeader + static_cast<std::size_t>(width) * height * 8);
  constexpr int kBorder = 16;
  int near = 0;
  int all = 0;
  for (int row = kBorder; row < height - kBorder; ++row) {
    for (int column = kBorder; column < width - kBorder; ++column) {
      float flow[2];
      std::memcpy(flow, bytes.data() + kHeader + (row * width + column) * 8, sizeof flow);
      ++all;
      near += std::abs(flow[0] - x) <= 0.5F && std::abs(flow[1] - y) <= 0.5F ? 1 : 0;
    }
  }
  return static_cast<double>(near) / all;
}

TEST_F(AutomaticDisparities, OfTwoDimensions) {
  // A plane at 5 to the left and 3 up; the same lying on its side.
  constexpr int kWidth = 240;
  constexpr int kHeight = 180;
  constexpr int kAcross = 5;
  constexpr int kDown = 3;
  BookPairOptions options = book_pair_options("real-square");
  options.width_px = kWidth + kAcross;
  options.height_px = kHeight + kDown;
  const Photograph texture = make_book_pair(options).left;
  const auto window = [&](int x, int y) {
    const auto& pixels = std::get<Image<std::uint8_t>>(texture.pixels);
    Image<std::uint8_t> part(kWidth, kHeight);
    for (int row = 0; row < kHeight; ++row) {
      std::copy_n(pixels.row(row + y) + x, kWidth, part.row(row));
    }
    return Photograph{std::move(part)};
  };
  write_photograph(folder_ / "a.png", window(0, 0));
  write_photograph(folder_ / "b.png", window(kAcross, kDown));
  write_photograph(folder_ / "at.png", transposed(window(0, 0)));
  write_photograph(folder_ / "bt.png", transposed(window(kAcross, kDown)));
  const auto match = [&](const char* first, const char* second, const Words& more) {
    const ProcessResult result = succeeds(
        run_vantage(joined({"match", folder_ / first, folder_ / second, "-o", folder_ / "o.flo",
                            "--disparities-y", "auto", "--method", "gradient"},
                           more)));
    EXPECT_THAT(result.err, AllOf(HasSubstr("match: --disparities-y auto is 2:4\n"),
                                  HasSubstr("match: --disparities auto is")));
  };
  match("a.png", "b.png", {"--report", folder_ / "r.json"});
  EXPECT_GT(share_at(folder_ / "o.flo", kWidth, kHeight, -kAcross, -kDown), 0.9);
  const auto report = read_json(folder_ / "r.json");
  EXPECT_EQ(report["settings"]["disparities-y"], "2:4");
  match("at.png", "bt.png", {"--vertical"});
  EXPECT_GT(share_at(folder_ / "o.flo", kHeight, kWidth, -kDown, -kAcross), 0.9);
}

}  // namespace vantage::automatic_disparities_test
