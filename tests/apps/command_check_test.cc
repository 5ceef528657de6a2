#include <random>

#include "tests/apps/pair_fixture.h"

namespace vantage::command_check_test {

/// A textured pair, all of it at a disparity of 6 px, as left.png and right.png.
class CheckCommand : public testing::Test {
 protected:
  static constexpr int kWidth = 160;
  static constexpr int kHeight = 120;
  static constexpr int kDisparity_px = 6;

  CheckCommand() {
    write_photograph(left_, {view(0)});
    write_photograph(right_, {view(kDisparity_px)});
  }

  /// Blocks of random grey levels of 3×3 pixels, `shift` columns further on.
  static Image<std::uint8_t> view(int shift, unsigned seed = 1) {
    std::mt19937 random(seed);
    constexpr int kBlock = 3;
    Image<std::uint8_t> blocks((kWidth + kDisparity_px) / kBlock + 1, kHeight / kBlock + 1);
    for (int y = 0; y < blocks.height(); ++y) {
      for (int x = 0; x < blocks.width(); ++x) {
        blocks.at(x, y) = static_cast<std::uint8_t>(random() % 200 + 20);
      }
    }
    Image<std::uint8_t> image(kWidth, kHeight);
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        image.at(x, y) = blocks.at((x + shift) / kBlock, y / kBlock);
      }
    }
    return image;
  }

  [[nodiscard]] ProcessResult check(const Words& arguments) const {
    return run_vantage(joined(joined({"check"}, arguments), {"--report", report_}));
  }
  [[nodiscard]] nlohmann::json results() const { return read_json(report_)["results"]; }

  TemporaryFolder folder_;
  std::string left_ = folder_ / "left.png";
  std::string right_ = folder_ / "right.png";
  std::string report_ = folder_ / "check.json";
};

TEST_F(CheckCommand, NamesTheCommandThatMatchesThePair) {
  const ProcessResult result = succeeds(check({left_, right_}));
  const auto found = results();
  const std::string command = found["command"];
  EXPECT_EQ(command, "vantage match " + left_ + " " + right_ + " -o disparity.pfm");
  EXPECT_THAT(result.out, HasSubstr(command));
  const auto pair = found["pairs"][0];
  EXPECT_EQ(pair["width_px"], kWidth);
  EXPECT_EQ(pair["left"]["bits"], 8);
  EXPECT_GT(pair["map"]["matched_share"], 0.8);
  EXPECT_GT(found["memory_bytes"], 1 << 20);
  int min = 0;
  int max = 0;
  ASSERT_EQ(std::sscanf(std::string(pair["disparities"]).c_str(), "%d:%d", &min, &max), 2);
  EXPECT_LE(min, kDisparity_px);
  EXPECT_GE(max, kDisparity_px);
  EXPECT_LE(max - min, 20);
}

TEST_F(CheckCommand, KeepsOptionsOfTheMatch) {
  succeeds(check({left_, right_, "--preset", "realtime", "--disparities=0:15", "--threads", "1"}));
  const std::string command = results()["command"];
  EXPECT_THAT(command, AllOf(HasSubstr(" --preset=realtime"), HasSubstr(" --disparities=0:15"),
                             Not(HasSubstr("threads"))));
  Words typed = words(command.substr(std::string("vantage ").size()));
  std::ranges::replace(typed, std::string("disparity.pfm"), folder_ / "disparity.pfm");
  succeeds(run_vantage(typed));
}

TEST_F(CheckCommand, SaysWhatFilesAndPixelsTell) {
  const std::string files[] = {folder_ / "left.jpg", folder_ / "right.jpg"};
  write_photograph(files[0], {view(0)});
  write_photograph(files[1], {view(kDisparity_px)});
  EXPECT_THAT(succeeds(check({files[0], files[1]})).out, HasSubstr("8 bits, JPEG in steps of"));
  EXPECT_EQ(results()["pairs"][0]["left"]["codec"], "JPEG");
  EXPECT_GT(results()["pairs"][0]["left"]["step_grey_levels"], 0);

  for (const int shift : {0, kDisparity_px}) {
    const Image<std::uint8_t> eight_bits = view(shift);
    Image<std::uint16_t> twelve_bits(kWidth, kHeight);
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        twelve_bits.at(x, y) = static_cast<std::uint16_t>(16 * eight_bits.at(x, y));
      }
    }
    write_photograph(shift == 0 ? left_ : right_, {std::move(twelve_bits)});
  }
  EXPECT_THAT(succeeds(check({left_, right_})).out, HasSubstr("white level: 4095"));
  EXPECT_NEAR(results()["pairs"][0]["left"]["mean_grey"], 119.5, 5);
  EXPECT_EQ(results()["pairs"][0]["left"]["bits"], 16);
}

TEST_F(CheckCommand, ExchangesSidesThatAreExchanged) {
  succeeds(check({right_, left_}));
  EXPECT_EQ(results()["pairs"][0]["rectification"]["looks_exchanged"], true);
  EXPECT_THAT(std::string(results()["command"]), HasSubstr("match " + left_ + " " + right_));
}

TEST_F(CheckCommand, RefusesWhatNobodyCanMatch) {
  const std::string black = folder_ / "black.png";
  write_grey(black, kWidth, kHeight, 0);
  expect_one_line(check({black, black}), 1, "check", "a match makes no sense: ");
  EXPECT_EQ(results()["makes_sense"], false);
  EXPECT_FALSE(results().contains("command"));

  expect_one_line(check({left_, left_, "--quiet"}), 1, "check", "are the same picture");

  const std::string unrelated = folder_ / "unrelated.png";
  write_photograph(unrelated, {view(0, 2)});
  expect_one_line(check({left_, unrelated, "--quiet"}), 1, "check", "makes no sense");

  const std::string pixel = folder_ / "pixel.png";
  write_grey(pixel, 1, 1, 90);
  expect_one_line(check({pixel, pixel}), 1, "check", "makes no sense");
  expect_one_line(check({left_, black, "--packing", "sbsl"}), 2, "check", "--packing");
  expect_one_line(check({left_}), 2, "check", "RIGHT is missing; --stereo needs --packing");
  expect_one_line(check({left_, pixel}), 1, "check", "160x120 and 1x1, expected equal sizes");
  expect_one_line(check({left_, folder_ / "none.png"}), 1, "check", "none.png");
}

TEST_F(CheckCommand, LooksAtTheEndsAndTheMiddleOfASequence) {
  const std::string folders[] = {folder_ / "left", folder_ / "right"};
  for (const bool is_right : {false, true}) {
    const std::string& frames = folders[is_right ? 1 : 0];
    fs::create_directories(frames);
    for (unsigned frame = 0; frame < 6; ++frame) {
      write_photograph(frames + "/" + std::to_string(frame) + ".png",
                       {view(is_right ? kDisparity_px : 0, frame + 1)});
    }
    // A film may begin with black.
    write_grey(frames + "/0.png", kWidth, kHeight, 0);
  }
  succeeds(check({folders[0], folders[1]}));
  const auto found = results();
  EXPECT_EQ(found["pair_count"], 6);
  std::vector<int> examined;
  for (const auto& pair : found["pairs"]) {
    examined.push_back(pair["index"]);
  }
  EXPECT_THAT(examined, ElementsAre(0, 2, 5));
  EXPECT_FALSE(found["pairs"][0]["problems"].empty());
  EXPECT_TRUE(found["pairs"][1]["problems"].empty());
  EXPECT_EQ(found["command"],
            "vantage run --left " + folders[0] + " --right " + folders[1] + " -o results");
}

TEST_F(CheckCommand, TakesPicturesThatHoldBothImages) {
  Image<std::uint8_t> both(2 * kWidth, kHeight);
  const Image<std::uint8_t> views[] = {view(0), view(kDisparity_px)};
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < 2 * kWidth; ++x) {
      both.at(x, y) = views[x / kWidth].at(x % kWidth, y);
    }
  }
  const std::string frames = folder_ / "both ways";
  fs::create_directories(frames);
  write_photograph(frames + "/0.png", {std::move(both)});
  succeeds(check({frames, "--packing", "sbsl"}));
  EXPECT_EQ(results()["pairs"][0]["width_px"], kWidth);
  EXPECT_EQ(results()["command"],
            "vantage run --stereo '" + frames + "' -o results --packing=sbsl");
}

}  // namespace vantage::command_check_test
