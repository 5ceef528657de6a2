// Sequences: maps beside the disparity map are those of 'vantage match'.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "tests/apps/run_fixture.h"

namespace vantage {
namespace run_further_maps_test {

using testing::HasSubstr;

class RunFurtherMaps : public RunTest {
 protected:
  /// With the default preset.
  [[nodiscard]] ProcessResult run(const std::string& out,
                                  const std::vector<std::string>& more) const {
    return run_vantage(joined(
        {"run", "--left", left_, "--right", right_, "-o", out, "--disparities=0:9", "--quiet"},
        more));
  }
  /// `match` of frame 2.
  void match_frame(const std::vector<std::string>& more) const {
    const ProcessResult result =
        run_vantage(joined({"match", left_ + "/" + frame_file(2), right_ + "/" + frame_file(2),
                            "-o", folder_ / "map.pfm", "--disparities=0:9"},
                           more));
    ASSERT_EQ(result.exit_code, 0) << result.err;
  }
};

TEST_F(RunFurtherMaps, AreThoseOfMatch) {
  const std::vector<std::string> frames = {"--frames", "2-3", "--chunk-frames", "1"};
  const std::string moments = folder_ / "moments";
  for (const std::string reference : {"left", "right"}) {
    const std::string out = moments + "-" + reference;
    ASSERT_EQ(run(out, joined(frames, {"--save", "posterior-mean,posterior-variance", "--reference",
                                       reference}))
                  .exit_code,
              0);
    match_frame({"--posterior-mean", folder_ / "mean.pfm", "--posterior-variance",
                 folder_ / "variance.pfm", "--reference", reference});
    EXPECT_TRUE(results_in(out)["posterior-mean/000002.pfm"] == read_file(folder_ / "mean.pfm"));
    EXPECT_TRUE(results_in(out)["posterior-variance/000002.pfm"] ==
                read_file(folder_ / "variance.pfm"));
  }
  const std::string middle = folder_ / "middle";
  ASSERT_EQ(run(middle, joined(frames, {"--save", "cyclopean,cyclopean-occlusion", "--selection",
                                        "symmetric"}))
                .exit_code,
            0);
  match_frame({"--cyclopean", folder_ / "middle.pfm", "--cyclopean-occlusion",
               folder_ / "middle.png", "--selection", "symmetric"});
  EXPECT_TRUE(results_in(middle)["cyclopean/000002.pfm"] == read_file(folder_ / "middle.pfm"));
  EXPECT_TRUE(results_in(middle)["cyclopean-occlusion/000002.png"] ==
              read_file(folder_ / "middle.png"));
}

TEST_F(RunFurtherMaps, AreMadeAgainForAVideo) {
  const std::vector<std::string> outputs = {
      "--save",  "disparity,cyclopean-occlusion", "--selection",    "symmetric",
      "--video", "cyclopean-occlusion",           "--chunk-frames", "5"};
  const std::string out = folder_ / "out";
  ASSERT_EQ(RunTest::run(out, joined(outputs, {"--frames", "0-7"})).exit_code, 0);
  ASSERT_EQ(RunTest::run(out, joined(outputs, {"--resume"})).exit_code, 0);
  EXPECT_TRUE(same_files(results_in(out), undisturbed(outputs)));
}

TEST_F(RunFurtherMaps, AreRefusedWhereThereAreNone) {
  struct Case {
    std::vector<std::string> arguments;
    std::string message;
  };
  for (const Case& test : std::vector<Case>{
           {{"--save", "cyclopean"}, "expected them with selection symmetric only"},
           {{"--save", "posterior-mean", "--method", "ssd"}, "expected the aggregation bayes"},
           {{"--save", "posterior-variance", "--preset", "realtime"}, "expected search-size full"},
           {{"--save", "posterior-variance", "--format", "png"}, "save has posterior-variance"},
           {{"--save", "disparity,posterior-mean", "--video", "posterior-mean"},
            "whose values a video cannot hold"}}) {
    const ProcessResult result = run(folder_ / "out", test.arguments);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_TRUE(is_one_line(result, "run"));
    EXPECT_THAT(result.err, HasSubstr(test.message));
  }
  for (const std::string option : {"--cyclopean", "--cyclopean-occlusion"}) {
    const ProcessResult result =
        run_vantage({"match", left_ + "/" + frame_file(0), right_ + "/" + frame_file(0), "-o",
                     folder_ / "map.pfm", option, folder_ / "middle.png"});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_THAT(result.err, HasSubstr(option + " is given, expected it with --selection"));
  }
}

}  // namespace run_further_maps_test
}  // namespace vantage
