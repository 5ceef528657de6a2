// Runs that keep up with a stream, and runs beside a window.

#include <sys/wait.h>

#include "tests/apps/sampling.h"
#include "tests/apps/stream_fixture.h"

namespace vantage::run_live_test {

class RunLive : public StreamTest {
 protected:
  RunLive() { write_file(folder_ / "pairs.rgb", raw_pairs(kFrames)); }

  /// The command of a live run that reads `input` in the folder.
  [[nodiscard]] std::string live(const Words& more, const std::string& input = "pairs.rgb") const {
    return command(joined({"--stereo", "-", "--packing", "sbsl", "--raw-video", "128x48", "--live",
                           "--method", "ssd", "--disparities=0:9"},
                          more)) +
           " <" + (folder_ / input);
  }
  [[nodiscard]] nlohmann::json live_report() const {
    return read_json(folder_ / "report.json")["results"]["live"];
  }
};

TEST_F(RunLive, TheNewestPairIsMatchedAndOthersAreCounted) {
  ASSERT_EQ(shell(live({"-o", folder_ / "live", "--report", folder_ / "report.json"})), 0) << err();
  succeeds(run(folder_ / "maps", {"--method", "ssd"}));
  const nlohmann::json report = live_report();
  int frames = 0;
  for (const auto& file : fs::directory_iterator(folder_ / "live/disparity")) {
    // Named by its number in the stream.
    EXPECT_EQ(read_file(file.path()),
              read_file(folder_ / ("maps/disparity/" + file.path().filename().string())))
        << file.path();
    ++frames;
  }
  EXPECT_TRUE(fs::exists(folder_ / ("live/disparity/" + frame_file(kFrames - 1, "pfm"))));
  EXPECT_EQ(report["frames"], frames);
  EXPECT_EQ(report["frames"].get<int>() + report["dropped"].get<int>(), kFrames);
  EXPECT_LE(report["latency_ms"]["p50"], report["latency_ms"]["p95"]);
  EXPECT_THAT(err(), HasSubstr("run: live: " + std::to_string(frames) + " frame"));
  EXPECT_EQ(run_vantage({"verify", folder_ / "live"}).exit_code, 0);
}

TEST_F(RunLive, WritesAStream) {
  const Words wanted = {"--save",          "preview",  "-o",       "-",
                        "--stream-format", "rawvideo", "--report", folder_ / "report.json"};
  ASSERT_EQ(shell(live(wanted) + " >" + (folder_ / "out.rgb")), 0) << err();
  EXPECT_EQ(read_file(folder_ / "out.rgb").size(),
            3U * kWidth * kHeight * live_report()["frames"].get<std::size_t>());
}

/// A sender that waits for the result of each pair.
TEST_F(RunLive, NothingIsDroppedThatIsWaitedFor) {
  ASSERT_EQ(shell("cd " + folder_.path().string() +
                  "; mkfifo in; { for i in 0 1 2; do tail -c +$((18432 * i + 1)) pairs.rgb | head "
                  "-c 18432; while [ ! -e answered/disparity/00000$i.pfm ]; do sleep 0.02; done; "
                  "done; } >in & " +
                  live({"-o", folder_ / "answered", "--report", folder_ / "report.json"}, "in")),
            0)
      << err();
  EXPECT_EQ(live_report()["frames"], 3);
  EXPECT_EQ(live_report()["dropped"], 0);
}

TEST_F(RunLive, WrongOptions) {
  const auto from_input = [&](const Words& more) {
    return joined({"--stereo", "-", "--packing", "sbsl", "--live", "-o", folder_ / "out"}, more);
  };
  const std::vector<Refusal> refusals = {
      {from_input({"--in-flight", "2"}), "--in-flight cannot be used with --live"},
      {from_input({"--every", "2"}), "--every cannot be used with --live"},
      {from_input({"--frames", "0-3"}), "--frames cannot be used with --live"},
      {from_input({"--save", "preview", "--video", "preview"}), "a video of fewer frames"},
      {{"--left", left_, "--right", right_, "--live", "-o", folder_ / "out"}, "no stream"}};
  expect_refusals("run", folder_.path(), refusals,
                  [&](const Words& words) { return run_vantage(joined({"run"}, words)); });
}

TEST_F(RunLive, AWindowNeedsAScreen) {
  const std::string show =
      command({"--left", left_, "--right", right_, "-o", folder_ / "out", "--show"});
  EXPECT_NE(shell("unset QT_QPA_PLATFORM; export DISPLAY=:9876; " + show), 0);
  EXPECT_THAT(err(), HasSubstr("--show needs a screen, but DISPLAY :9876 does not answer"));
  EXPECT_FALSE(fs::exists(folder_ / "out"));
}

/// The second run would go on, but for a key.
TEST_F(RunLive, AWindowShowsARun) {
  if (shell("command -v Xvfb >/dev/null && command -v xdotool >/dev/null") != 0) {
    GTEST_SKIP() << "no Xvfb or xdotool here";
  }
  const std::string screen =
      "cd " + folder_.path().string() +
      "; unset QT_QPA_PLATFORM; Xvfb -displayfd 3 -screen 0 640x480x24 3>display 2>/dev/null & "
      "server=$!; while [ ! -s display ]; do sleep 0.05; done; export DISPLAY=:$(cat display); ";
  const std::string plain =
      command({"--left", left_, "--right", right_, "--disparities=0:9", "--method", "ssd", "-o",
               folder_ / "shown", "--show", "--view", "0.5"});
  EXPECT_EQ(shell(screen + plain + "; code=$?; kill $server; exit $code"), 0) << err();
  EXPECT_TRUE(same_files(results_in(folder_ / "shown"), undisturbed({"--view", "0.5"})));
  fs::remove(folder_ / "display");
  // The pipe stays open: only the key ends this run.
  const std::string endless =
      "mkfifo in; { cat pairs.rgb; exec sleep 60; } >in & sender=$!; " +
      live({"-o", folder_ / "closed", "--show"}, "in") + " & run=$!; " +
      "while [ ! -e closed/disparity/000019.pfm ]; do sleep 0.05; done; "
      "xdotool search --sync --name 'vantage run' windowfocus key q; wait $run; code=$?; "
      "kill $sender $server; exit $code";
  EXPECT_EQ(shell(screen + endless), 130) << err();
  EXPECT_THAT(err(), HasSubstr("(interrupted)"));
  EXPECT_EQ(run_vantage({"verify", folder_ / "closed"}).exit_code, 0);
}

}  // namespace vantage::run_live_test
