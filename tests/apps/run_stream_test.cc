// Runs that read standard input and write standard output.

#include <cstdlib>

#include "engine/io/video/video_io.h"
#include "tests/apps/sampling.h"
#include "tests/apps/stream_fixture.h"

namespace vantage::run_stream_test {

class RunStreams : public StreamTest {
 protected:
  Words depth_ = words(
      "--stereo - --packing sbsl --raw-video 128x48 --save depth-video --depth-range -1:10 "
      "--disparities=0:9 --method ssd --stream-format rawvideo -o - --quiet");
};

TEST_F(RunStreams, RawPairsInRawDepthOut) {
  constexpr int kFew = 5;
  succeeds(run(folder_ / "maps", {"--frames", "0-4"}));
  write_file(folder_ / "pairs.rgb", raw_pairs(kFew));
  ASSERT_EQ(shell("cat " + (folder_ / "pairs.rgb") + " | " + command(depth_) + " >" +
                  (folder_ / "depth.raw")),
            0)
      << err();
  const std::string levels = read_file(folder_ / "depth.raw");
  ASSERT_EQ(levels.size(), 2U * kFew * kWidth * kHeight);
  std::size_t place = 0;
  int wrong = 0;
  for (int frame = 0; frame < kFew; ++frame) {
    const DisparityMap map =
        read_disparity(folder_ / ("maps/disparity/" + frame_file(frame, "pfm")));
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x, place += 2) {
        const int level = static_cast<unsigned char>(levels[place]) +
                          256 * static_cast<unsigned char>(levels[place + 1]);
        const double expected = 1 + (static_cast<double>(map.at(x, y)) + 1) / 11 * 65534;
        wrong += std::abs(level - expected) > 0.6 ? 1 : 0;
      }
    }
  }
  EXPECT_EQ(wrong, 0);
}

TEST_F(RunStreams, Y4mThroughTwoPrograms) {
  const std::string pairs = folder_ / "pairs.y4m";
  const std::string through = folder_ / "through.y4m";
  const std::string again = folder_ / "again.y4m";
  const Words source = {"--left", left_,        "--right",
                        right_,   "--frames",   "2-9",
                        "--fps",  "24000/1001", "--disparities=0:9",
                        "--save", "stereo",     "--stereo-packing",
                        "sbsl",   "-o",         "-",
                        "--quiet"};
  const auto preview_of = [](const std::string& stereo) {
    return Words{"--stereo", stereo,    "--packing", "sbsl", "--disparities=0:9",
                 "--save",   "preview", "-o",        "-",    "--quiet"};
  };
  ASSERT_EQ(shell(command(source) + " | tee " + pairs + " | " + command(preview_of("-")) + " >" +
                  through),
            0)
      << err();
  ASSERT_EQ(shell(command(preview_of(pairs)) + " >" + again), 0) << err();
  EXPECT_TRUE(read_file(through) == read_file(again));
  VideoReader reader(through);
  EXPECT_EQ(reader.frame_count(), 8);
  EXPECT_EQ(reader.width(), kWidth);
  EXPECT_EQ(reader.height(), kHeight);
  EXPECT_EQ(reader.frame_rate(), (FrameRate{24000, 1001}));
  // A stream of depth, of every second pair.
  Words depth = preview_of("-");
  depth[6] = "depth-video";
  depth.insert(depth.end(), {"--every", "2"});
  ASSERT_EQ(shell(command(depth) + " <" + pairs + " >" + again), 0) << err();
  VideoReader grey(again);
  EXPECT_EQ(grey.frame_count(), 4);
  Photograph picture;
  ASSERT_TRUE(grey.read(picture));
  EXPECT_EQ(picture.channels(), 1);
  EXPECT_TRUE(std::holds_alternative<Image<std::uint16_t>>(picture.pixels));
}

TEST_F(RunStreams, StreamsThatEndEarly) {
  const std::string bytes = raw_pairs(3);
  write_file(folder_ / "cut.rgb", bytes.substr(0, bytes.size() - 100));
  EXPECT_EQ(shell(command(depth_) + " <" + (folder_ / "cut.rgb") + " >" + (folder_ / "out.raw")),
            1);
  EXPECT_THAT(err(), HasSubstr("standard input frame 2"));
  EXPECT_EQ(read_file(folder_ / "out.raw").size(), 2U * 2 * kWidth * kHeight);
  EXPECT_EQ(shell(command(depth_) + " </dev/null >" + (folder_ / "out.raw")), 1);
  EXPECT_THAT(err(), HasSubstr("standard input"));
  write_file(folder_ / "pairs.rgb", raw_pairs(3));
  const Words search = words("--stereo - --packing sbsl --disparities=0:9 --method ssd -o -");
  const std::string to_y4m = command(
      joined(search, {"--raw-video", "128x48", "--save", "stereo", "--stereo-packing", "sbsl"}));
  ASSERT_EQ(shell(to_y4m + " <" + (folder_ / "pairs.rgb") + " >" + (folder_ / "whole.y4m")), 0)
      << err();
  const std::string y4m = read_file(folder_ / "whole.y4m");
  for (const std::size_t missing : {std::size_t{0}, std::size_t{7}, y4m.size() / 6}) {
    write_file(folder_ / "cut.y4m", y4m.substr(0, y4m.size() - missing));
    EXPECT_EQ(shell(command(joined(search, {"--save", "preview"})) + " <" + (folder_ / "cut.y4m") +
                    " >" + (folder_ / "out.y4m")),
              missing == 0 ? 0 : 1);
    EXPECT_EQ(err().find("standard input frame 2: the stream ends inside it") != std::string::npos,
              missing != 0)
        << err();
  }
  // The frame that is left out is shown as the one before it.
  const std::string good = read_file(folder_ / "out.y4m");
  EXPECT_EQ(shell(command(joined(search, {"--save", "preview", "--keep-going"})) + " <" +
                  (folder_ / "cut.y4m") + " >" + (folder_ / "out.y4m")),
            3);
  const std::size_t frame_bytes = std::string("FRAME\n").size() + kWidth * kHeight * 3U / 2;
  const std::string kept_going = read_file(folder_ / "out.y4m");
  ASSERT_EQ(kept_going.size(), good.size() + frame_bytes);
  EXPECT_EQ(kept_going.substr(0, good.size()), good);
  EXPECT_EQ(kept_going.substr(good.size()), good.substr(good.size() - frame_bytes));
  write_file(folder_ / "text.y4m", "no video\n");
  EXPECT_EQ(shell(command({"--stereo", "-", "--packing", "sbsl", "--save", "preview", "-o", "-"}) +
                  " <" + (folder_ / "text.y4m") + " >" + (folder_ / "out.raw")),
            1);
  EXPECT_THAT(err(), HasSubstr("standard input: is empty or no video that can be streamed"));
  // Nobody reads any longer.
  write_file(folder_ / "pairs.rgb", raw_pairs(kFrames));
  EXPECT_EQ(shell("{ " + command(depth_) + " <" + (folder_ / "pairs.rgb") + "; echo $? >" +
                  (folder_ / "code") + "; } | true"),
            0);
  EXPECT_EQ(read_file(folder_ / "code"), "1\n");
  EXPECT_THAT(err(), HasSubstr("cannot write to standard output"));
}

TEST_F(RunStreams, WrongOptions) {
  const auto from_input = [&](const Words& more) {
    return joined({"--stereo", "-", "--packing", "sbsl", "-o", folder_ / "out"}, more);
  };
  const auto to_output = [&](const Words& more) {
    return joined({"--left", left_, "--right", right_, "-o", "-", "--save", "preview"}, more);
  };
  const std::vector<Refusal> refusals = {
      {from_input({"--resume"}), "a stream, which cannot be read again"},
      {from_input({"--force"}), "a stream, which cannot be read again"},
      {from_input({"--shard", "1/2"}), "a stream is read once"},
      {from_input({"--save", "comfort", "--search-range", "shot"}), "search-range is shot"},
      {from_input({"--save", "depth-video", "--depth-range", "shot"}), "depth-range is shot"},
      {from_input({"--save", "preview", "--preview-range", "shot"}), "preview-range is shot"},
      {from_input({"--view", "0.5", "--intensity-fit", "shot"}), "intensity-fit is shot"},
      {{"--left", left_, "--right", right_, "-o", "-"}, "--save with one output of pictures"},
      {{"--left", left_, "--right", right_, "-o", "-", "--save", "preview,unmatched"},
       "--save with one output of pictures"},
      {to_output({"--preview-range", "shot"}), "expected no shots"},
      {to_output({"--resume"}), "--resume has no effect"},
      {{"--left", left_, "--right", right_, "-o", folder_ / "out", "--stream-format", "rawvideo"},
       "--stream-format has no effect"},
      {{"--left", left_, "--right", right_, "-o", folder_ / "out", "--raw-video", "4x4"},
       "--raw-video has no effect"},
      {{"--stereo", "-", "--packing", "sbsl", "-o", "-", "--save", "preview", "--raw-video", "4"},
       "--raw-video is '4', expected a size"},
      {from_input({"--raw-video", "4x4:nonsense"}), "has the pixel format 'nonsense', expected"}};
  expect_refusals("run", folder_.path(), refusals,
                  [&](const Words& words) { return run_vantage(joined({"run"}, words)); });
}

}  // namespace vantage::run_stream_test
