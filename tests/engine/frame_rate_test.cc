#include "engine/io/video/frame_rate.h"

#include "tests/engine/engine_test.h"

namespace vantage::frame_rate_test {

std::string parsed(const std::string& text) {
  const auto rate = parse_frame_rate(text);
  return rate ? to_string(*rate) : "none";
}

TEST(FrameRate, WholeNumbersDecimalsAndFractions) {
  const std::vector<std::pair<std::string, std::string>> cases = {{"25", "25"},
                                                                  {"025", "25"},
                                                                  {"1", "1"},
                                                                  {"1000", "1000"},
                                                                  {"12.5", "25/2"},
                                                                  {"25.0", "25"},
                                                                  {"25.", "25"},
                                                                  {".5", "1/2"},
                                                                  {"0.001", "1/1000"},
                                                                  {"30000/1001", "30000/1001"},
                                                                  {"60/2", "30"},
                                                                  {"1/1000000", "1/1000000"},
                                                                  {"1000000/1000", "1000"},
                                                                  {"23.98", "1199/50"},
                                                                  {"14.9", "149/10"},
                                                                  {"999", "999"},
                                                                  {"999.0", "999"},
                                                                  {"29.5", "59/2"}};
  for (const auto& [text, expected] : cases) {
    EXPECT_EQ(parsed(text), expected) << text;
  }
}

TEST(FrameRate, DecimalsNearTelevisionRatesAreThose) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"29.97", "30000/1001"},        {"29.970", "30000/1001"},  {"29.97003", "30000/1001"},
      {"23.976", "24000/1001"},       {"23.9760", "24000/1001"}, {"23.976024", "24000/1001"},
      {"59.94", "60000/1001"},        {"119.88", "120000/1001"}, {"14.985", "15000/1001"},
      {"29.9700299700", "30000/1001"}};
  for (const auto& [text, expected] : cases) {
    EXPECT_EQ(parsed(text), expected) << text;
  }
}

TEST(FrameRate, AllElseIsRefused) {
  for (const char* text : {"",           "0",          "0.0",
                           "-25",        "+25",        " 25",
                           "25 ",        "25fps",      "x",
                           "1e3",        "nan",        "inf",
                           "1000.1",     "1001",       "0/1",
                           "1/0",        "/",          "1/",
                           "/2",         "1/2/3",      "1.5/2",
                           "1.2.3",      ".",          "1000001/1001",
                           "1/1000001",  "12.3456789", "99999999999999999999",
                           "0.00000001", "25,5",       "1000000/1"}) {
    EXPECT_EQ(parsed(text), "none") << text;
  }
}

TEST(FrameRate, RatesPerSecondAndText) {
  EXPECT_DOUBLE_EQ((FrameRate{30000, 1001}.per_second()), 30000.0 / 1001);
  EXPECT_EQ(to_string(FrameRate{}), "25");
  for (int whole = 1; whole <= 1000; ++whole) {
    const FrameRate rate{whole * 1000LL, 1001};
    const auto again = parse_frame_rate(to_string(rate));
    ASSERT_TRUE(again);
    EXPECT_NEAR(again->per_second(), rate.per_second(), 1e-9);
    EXPECT_EQ(parsed(std::to_string(whole)), std::to_string(whole));
  }
}

}  // namespace vantage::frame_rate_test
