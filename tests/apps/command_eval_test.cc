#include <limits>

#include "tests/apps/pair_fixture.h"

namespace vantage::command_eval_test {

class EvalCommand : public testing::Test {
 protected:
  /// 4×2 pixels: errors 0, 0.75, 3, unknown in the upper row, 0 in the lower one.
  EvalCommand() {
    DisparityMap truth(4, 2);
    truth.fill(10);
    DisparityMap map = truth.copy();
    map.at(1, 0) = 10.75F;
    map.at(2, 0) = 7;
    map.at(3, 0) = std::numeric_limits<float>::quiet_NaN();
    write_disparity(truth_, truth.view());
    write_disparity(map_, map.view());
  }

  [[nodiscard]] nlohmann::json results(const Words& arguments) const {
    const Words report = {"--report", folder_ / "r.json"};
    const ProcessResult result = succeeds(run_vantage(joined(joined({"eval"}, arguments), report)));
    EXPECT_EQ(result.err, "");
    table_ = result.out;
    return read_json(folder_ / "r.json")["results"];
  }

  TemporaryFolder folder_;
  std::string truth_ = folder_ / "truth.pfm";
  std::string map_ = folder_ / "map.pfm";
  mutable std::string table_;
};

TEST_F(EvalCommand, CountsUnknownPixelsAsBad) {
  const auto scores = results({map_, truth_});
  EXPECT_EQ(scores["evaluated_pixels"], 8);
  EXPECT_EQ(scores["coverage_percent"], 87.5);
  EXPECT_EQ(scores["bad_0_5_percent"], 37.5);
  EXPECT_EQ(scores["bad_1_percent"], 25);
  EXPECT_EQ(scores["bad_4_percent"], 12.5);
  EXPECT_NEAR(scores["average_px"], 3.75 / 7, 1e-9);
  EXPECT_THAT(table_, HasSubstr("bad 0.5"));
  EXPECT_THAT(table_, HasSubstr("37.500 %"));
}

TEST_F(EvalCommand, ScalesAndMasks) {
  write_grey(folder_ / "truth.png", 4, 2, 40);
  EXPECT_EQ(results({map_, folder_ / "truth.png", "--scale", "4"}), results({map_, truth_}));

  Mask mask(4, 2);
  mask.fill(0);
  mask.at(0, 0) = 255;
  mask.at(2, 0) = 255;
  write_mask(folder_ / "mask.png", mask.view());
  const auto scores = results({map_, truth_, "--mask", folder_ / "mask.png"});
  EXPECT_EQ(scores["evaluated_pixels"], 2);
  EXPECT_EQ(scores["bad_1_percent"], 50);

  Image<std::uint8_t> colour(4, 2, 3);
  colour.fill(255);
  colour.at(3, 0, 2) = 254;  // not quite white
  write_photograph(folder_ / "colour.png", {std::move(colour)});
  EXPECT_EQ(results({map_, truth_, "--mask", folder_ / "colour.png"})["evaluated_pixels"], 7);
}

TEST_F(EvalCommand, ComparesViews) {
  write_grey(folder_ / "a.png", 20, 15, 100);
  write_grey(folder_ / "b.png", 20, 15, 110);
  const auto scores = results({"--views", folder_ / "a.png", folder_ / "b.png"});
  EXPECT_NEAR(scores["psnr_db"], 20 * std::log10(25.5), 1e-9);
  EXPECT_EQ(scores["mean_absolute_difference"], 10);
  EXPECT_LT(scores["ssim"], 1);
  const auto equal = results({"--views", folder_ / "a.png", folder_ / "a.png"});
  EXPECT_TRUE(equal["psnr_db"].is_null());  // infinite, which JSON cannot hold
  EXPECT_THAT(table_, HasSubstr("inf dB"));
}

TEST_F(EvalCommand, ComparesSequencesOfViews) {
  for (const char* folder : {"views", "truth", "masks"}) {
    std::filesystem::create_directory(folder_ / folder);
  }
  Mask mask(20, 15);
  mask.fill(0);
  mask.at(3, 4) = 255;
  for (int frame = 0; frame < 3; ++frame) {
    const std::string name = "/00000" + std::to_string(frame) + ".png";
    const auto grey = static_cast<std::uint8_t>(100 + 20 * frame);
    write_grey((folder_ / "truth") + name, 20, 15, grey);
    write_mask((folder_ / "masks") + name, mask.view());
    if (frame > 0) {  // the first view is missing
      write_grey((folder_ / "views") + name, 20, 15,
                 static_cast<std::uint8_t>(grey + 6 * (frame - 1)));
    }
  }
  const Words folders = {"--views", folder_ / "views", folder_ / "truth"};
  const ProcessResult told = succeeds(run_vantage(joined({"eval"}, folders)));
  EXPECT_THAT(told.err, HasSubstr("without a partner"));
  const Words report = {"--quiet", "--report", folder_ / "r.json"};
  succeeds(run_vantage(
      joined(joined({"eval"}, folders), joined({"--mask", folder_ / "masks"}, report))));
  const nlohmann::json scores = read_json(folder_ / "r.json")["results"];
  EXPECT_EQ(scores["pixels"], 2);
  EXPECT_EQ(scores["mean_absolute_difference"], 3);
  EXPECT_EQ(scores["flicker_levels"], 6);
  EXPECT_EQ(scores["masked_flicker_levels"], 6);
  EXPECT_EQ(scores["frames"].size(), 2U);
}

using InputEvalCommand = EvalCommand;

TEST_F(InputEvalCommand, BadInputIsOneLine) {
  DisparityMap small(3, 2);
  small.fill(1);
  write_disparity(folder_ / "small.pfm", small.view());
  const std::vector<std::pair<Words, int>> cases = {{{map_}, 2},
                                                    {{map_, folder_ / "none.pfm"}, 1},
                                                    {{map_, folder_ / "small.pfm"}, 1},
                                                    {{map_, truth_, "--ignore-border", "-1"}, 2},
                                                    {{map_, truth_, "--ignore-border", "9"}, 1},
                                                    {{map_, truth_, "--scale", "0"}, 2},
                                                    {{"--views", map_, truth_, "--scale", "4"}, 2},
                                                    {{map_, truth_, "--mask", map_}, 1}};
  for (const auto& [arguments, exit_code] : cases) {
    expect_one_line(run_vantage(joined({"eval"}, arguments)), exit_code, "eval");
  }
}

}  // namespace vantage::command_eval_test
