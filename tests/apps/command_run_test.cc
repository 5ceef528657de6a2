#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <nlohmann/json.hpp>
#include <thread>

#include "engine/io/video_io.h"
#include "tests/apps/pair_fixture.h"

namespace vantage {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr int kFrames = 6;

class RunCommand : public testing::Test {
 protected:
  RunCommand() {
    std::filesystem::create_directories(left_);
    std::filesystem::create_directories(right_);
    for (int frame = 0; frame < kFrames; ++frame) {
      BookPairOptions options;
      options.width_px = 47;
      options.height_px = 29;
      options.seed = static_cast<std::uint64_t>(frame + 1);
      const BookPair pair = make_book_pair(options);
      write_photograph(left_ + name(frame), pair.left);
      write_photograph(right_ + name(frame), pair.right);
    }
  }

  static std::string name(int frame) { return "/frame" + std::to_string(frame) + ".png"; }

  [[nodiscard]] std::vector<std::string> arguments(
      const std::string& out, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> all = {"run",  "--left", left_, "--right",
                                    right_, "-o",     out,   "--disparities=0:9"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  [[nodiscard]] ProcessResult run(const std::string& out,
                                  const std::vector<std::string>& more = {}) const {
    return run_vantage(arguments(out, more));
  }

  TemporaryFolder folder_;
  std::string left_ = folder_ / "left";
  std::string right_ = folder_ / "right";
};

TEST_F(RunCommand, EveryFrameEqualsTheSingleCommands) {
  const std::string out = folder_ / "out";
  const ProcessResult result =
      run(out, {"--save", "disparity,right-disparity,unmatched,preview,views", "--view", "0.5",
                "--report", folder_ / "r.json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("6 frames"));
  for (int frame = 0; frame < kFrames; ++frame) {
    const std::string left = left_ + name(frame);
    const std::string right = right_ + name(frame);
    ASSERT_EQ(run_vantage({"match", left, right, "--disparities=0:9", "-o", folder_ / "l.pfm",
                           "--output-right", folder_ / "r.pfm", "--unmatched", folder_ / "u.png",
                           "--preview", folder_ / "p.png"})
                  .exit_code,
              0);
    ASSERT_EQ(run_vantage({"synth", left, right, "--disparities=0:9", "-o", folder_ / "v.png",
                           "--view", "0.5"})
                  .exit_code,
              0);
    const auto written = [&](const std::string& kind, const std::string& extension) {
      return read_file(out + "/" + kind + "/00000" + std::to_string(frame) + extension);
    };
    EXPECT_EQ(written("disparity", ".pfm"), read_file(folder_ / "l.pfm")) << frame;
    EXPECT_EQ(written("right-disparity", ".pfm"), read_file(folder_ / "r.pfm")) << frame;
    EXPECT_EQ(written("unmatched", ".png"), read_file(folder_ / "u.png")) << frame;
    EXPECT_EQ(written("preview", ".png"), read_file(folder_ / "p.png")) << frame;
    EXPECT_EQ(written("views", ".png"), read_file(folder_ / "v.png")) << frame;
  }
  EXPECT_EQ(files_below(out).size(), 5U * kFrames);
  const auto report = nlohmann::json::parse(read_file(folder_ / "r.json"));
  EXPECT_EQ(report["command"], "run");
  EXPECT_EQ(report["results"]["frames"], kFrames);
  EXPECT_EQ(report["cells"], 47.0 * 29 * 10 * 2 * kFrames);
  EXPECT_LE(report["seconds"]["compute"], report["seconds"]["wall"]);
}

TEST_F(RunCommand, FilesDoNotDependOnExecutionNorFramesInFlight) {
  const std::vector<std::string> outputs = {
      "--save", "disparity,preview,views", "--view", "0.25", "--view", "1.5", "--format", "png"};
  const auto run_with = [&](const std::string& out, std::vector<std::string> more) {
    more.insert(more.end(), outputs.begin(), outputs.end());
    const ProcessResult result = run(out, more);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return files_below(out);
  };
  const std::string expected = folder_ / "expected";
  const auto names = run_with(expected, {"--executor", "serial", "--in-flight", "1"});
  ASSERT_EQ(names.size(), 4U * kFrames);
  EXPECT_EQ(names.back(), "views/1.5/000005.png");
  const std::vector<std::vector<std::string>> ways = {
      {"--executor", "tbb", "--threads", "1", "--in-flight", "2"},
      {"--executor", "tbb", "--threads", "4", "--in-flight", "5", "--strip-width", "9"},
      {"--executor", "tbb", "--threads", "3", "--in-flight", "1"},
      {"--executor", "openmp", "--threads", "1", "--in-flight", "1"},
      {"--executor", "openmp", "--threads", "4", "--in-flight", "3", "--band-height", "4"}};
  for (std::size_t way = 0; way < ways.size(); ++way) {
    const std::string out = folder_ / std::to_string(way);
    ASSERT_EQ(run_with(out, ways[way]), names);
    for (const std::string& file : names) {
      EXPECT_EQ(read_file(out + "/" + file), read_file(expected + "/" + file)) << file << way;
    }
  }
}

TEST_F(RunCommand, TakesPatternsGlobsAndVideos) {
  ASSERT_EQ(run(folder_ / "a").exit_code, 0);
  ASSERT_EQ(run_vantage({"run", "--left", left_ + "/frame%d.png", "--right", right_ + "/*.png",
                         "-o", folder_ / "b", "--disparities=0:9", "--quiet"})
                .exit_code,
            0);
  for (const std::string& file : files_below(folder_ / "a")) {
    EXPECT_EQ(read_file(folder_ / "a/" + file), read_file(folder_ / "b/" + file));
  }
  for (const std::string side : {"left", "right"}) {
    VideoWriter video(folder_ / (side + ".mp4"), 48, 30, 25);
    for (int frame = 0; frame < 3; ++frame) {
      Image<std::uint8_t> grey(48, 30);
      for (int y = 0; y < 30; ++y) {
        for (int x = 0; x < 48; ++x) {
          grey.at(x, y) = static_cast<std::uint8_t>(x * 37 + y * 11 + frame);
        }
      }
      video.write({std::move(grey)});
    }
    video.finish();
  }
  const ProcessResult result =
      run_vantage({"run", "--left", folder_ / "left.mp4", "--right", folder_ / "right.mp4", "-o",
                   folder_ / "c", "--disparities=0:9"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(files_below(folder_ / "c"),
              ElementsAre("disparity/000000.pfm", "disparity/000001.pfm", "disparity/000002.pfm"));
}

TEST_F(RunCommand, StopsAtTheFirstBadFrame) {
  const std::string whole = read_file(left_ + name(3));
  write_file(left_ + name(3), whole.substr(0, whole.size() / 2));
  for (const std::string executor : {"serial", "tbb", "openmp"}) {
    const std::string out = folder_ / executor;
    const ProcessResult result =
        run(out, {"--executor", executor, "--threads", "3", "--in-flight", "4"});
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_TRUE(is_one_line(result, "run"));
    EXPECT_THAT(result.err, HasSubstr("frame 3"));
    EXPECT_THAT(result.err, HasSubstr("frame3.png"));
    EXPECT_THAT(files_below(out), ElementsAre("disparity/000000.pfm", "disparity/000001.pfm",
                                              "disparity/000002.pfm"));
  }
}

TEST_F(RunCommand, NamesTheFrameWhoseSizesDiffer) {
  write_photograph(right_ + name(2), {Image<std::uint8_t>(4, 4)});
  const ProcessResult result = run(folder_ / "out", {"--in-flight", "4"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_TRUE(is_one_line(result, "run"));
  EXPECT_THAT(result.err, HasSubstr("frame 2 ("));
  EXPECT_THAT(result.err, HasSubstr(right_ + name(2)));
  EXPECT_THAT(files_below(folder_ / "out"),
              ElementsAre("disparity/000000.pfm", "disparity/000001.pfm"));
}

TEST_F(RunCommand, UnequalLengthsAreAnErrorAfterTheCommonFrames) {
  std::filesystem::remove(right_ + name(5));
  std::filesystem::remove(right_ + name(4));
  const ProcessResult result = run(folder_ / "out");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_TRUE(is_one_line(result, "run"));
  EXPECT_THAT(result.err, HasSubstr("frame 4: the right sequence has ended after 4 frames but the "
                                    "left one has 6"));
  EXPECT_EQ(files_below(folder_ / "out").size(), 4U);
}

TEST_F(RunCommand, InterruptFinishesTheFramesUnderWay) {
  // Enough frames that the signal comes long before the end.
  constexpr int kMany = 4000;
  for (int frame = kFrames; frame < kMany; ++frame) {
    std::filesystem::create_symlink(left_ + name(0), left_ + name(frame));
    std::filesystem::create_symlink(right_ + name(0), right_ + name(frame));
  }
  const std::string out = folder_ / "out";
  const TemporaryFolder streams;
  const VantageProcess process(arguments(out, {"--report", folder_ / "r.json"}), streams.path());
  for (int wait = 0; wait < 2000 && files_below(out).empty(); ++wait) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  process.send(SIGINT);
  const ProcessResult result = process.wait();
  EXPECT_EQ(result.exit_code, 130) << result.err;
  EXPECT_THAT(result.err, HasSubstr("interrupted"));
  const auto files = files_below(out);
  ASSERT_FALSE(files.empty());
  EXPECT_LT(files.size(), static_cast<std::size_t>(kMany));
  // No gap, no partial file: the last one is the one that the count says.
  char last[64];
  std::snprintf(last, sizeof last, "disparity/%06zu.pfm", files.size() - 1);
  EXPECT_EQ(files.back(), last);
  EXPECT_EQ(nlohmann::json::parse(read_file(folder_ / "r.json"))["results"]["frames"],
            files.size());
}

TEST_F(RunCommand, WrongUsageIsOneLineAndExit2) {
  const std::string out = folder_ / "out";
  const std::vector<std::pair<std::vector<std::string>, std::string>> misuses = {
      {{"--save", "disparity,colour"}, "--save is 'colour'"},
      {{"--save", "views"}, "expected --view XS"},
      {{"--save", "disparity", "--view", "0.5"}, "save has no views"},
      {{"--view", "0.5", "--view", "0.5"}, "given twice"},
      {{"--view", "0.5,1"}, "off the baseline"},
      {{"--format", "gif"}, "format is 'gif'"},
      {{"--in-flight", "0"}, "in-flight is 0"},
      {{"--reference", "right", "--save", "right-disparity"}, "right-disparity"},
      {{"--resume"}, "unknown option '--resume'"},
      {{"--shard", "1/2"}, "unknown option '--shard'"}};
  for (const auto& [more, says] : misuses) {
    const ProcessResult result = run(out, more);
    EXPECT_EQ(result.exit_code, 2) << says;
    EXPECT_TRUE(is_one_line(result, "run"));
    EXPECT_THAT(result.err, HasSubstr(says));
  }
  EXPECT_THAT(files_below(out), IsEmpty());
  std::filesystem::rename(left_, folder_ / "disparity");
  const ProcessResult result =
      run_vantage({"run", "--left", folder_ / "disparity", "--right", right_, "-o",
                   folder_.path().string(), "--disparities=0:9"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("would write into"));
}

TEST_F(RunCommand, BadSourcesAreOneLineAndExit1) {
  std::filesystem::create_directory(folder_ / "empty");
  for (const std::string& source :
       {folder_ / "none", folder_ / "empty", folder_ / "none/%03d.png", folder_ / "none/*.png"}) {
    const ProcessResult result =
        run_vantage({"run", "--left", left_, "--right", source, "-o", folder_ / "out"});
    EXPECT_EQ(result.exit_code, 1) << source;
    EXPECT_TRUE(is_one_line(result, "run"));
  }
  write_file(folder_ / "file", "not a folder");
  const ProcessResult result = run(folder_ / "file");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_TRUE(is_one_line(result, "run"));
}

}  // namespace
}  // namespace vantage
