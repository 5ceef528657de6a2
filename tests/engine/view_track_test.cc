#include "engine/sequence/view_track.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/error.h"

namespace vantage {
namespace {

using testing::HasSubstr;

std::string refusal(std::string_view text) {
  try {
    parse_view_track(text).validate();
  } catch (const UsageError& error) {
    return error.what();
  }
  return "";
}

TEST(ViewTrack, IsLinearBetweenKeysAndStillOutside) {
  const ViewTrack track = parse_view_track("10=0,20=1,24=-1");
  EXPECT_TRUE(track.moves());
  EXPECT_EQ(track.at(0).x, 0);
  EXPECT_EQ(track.at(10).x, 0);
  EXPECT_DOUBLE_EQ(track.at(13).x, 0.3);
  EXPECT_EQ(track.at(20).x, 1);
  EXPECT_DOUBLE_EQ(track.at(21).x, 0.5);
  EXPECT_EQ(track.at(24).x, -1);
  EXPECT_EQ(track.at(1000000).x, -1);
  EXPECT_EQ(track.at(21).y, 0);
  EXPECT_FALSE(ViewTrack::fixed({0.25, 1}).moves());
  EXPECT_EQ(ViewTrack::fixed({0.25, 1}).at(7), (BaselinePosition{0.25, 1}));
}

TEST(ViewTrack, KeysMayLeaveTheBaseline) {
  const ViewTrack track = parse_view_track("0=0.5,-1,4=0.5,8=1,2");
  EXPECT_EQ(track.at(0), (BaselinePosition{0.5, -1}));
  EXPECT_EQ(track.at(2), (BaselinePosition{0.5, -0.5}));
  EXPECT_EQ(track.at(4), (BaselinePosition{0.5, 0}));
  EXPECT_EQ(track.at(6), (BaselinePosition{0.75, 1}));
}

TEST(ViewTrack, TextBringsBackTheSame) {
  for (const char* text : {"0=0.5", "0=0,48=1,96=0", "3=-0.1,4=1e-3", "0=1,-2,5=0,7=0.5,1e-3"}) {
    const ViewTrack track = parse_view_track(text);
    EXPECT_EQ(parse_view_track(to_string(track)), track) << text;
  }
}

TEST(ViewTrack, RefusesWhatIsNoPath) {
  for (const char* text : {"", "0", "=1", "0=", "a=1", "0=1,", "0=1;2=3", "0.5=1", "0=1 ,2=3",
                           "2,0=1", "0=1,2,3", "0=1,"}) {
    EXPECT_THAT(refusal(text), HasSubstr("expected keys FRAME=XS")) << text;
  }
  EXPECT_THAT(refusal("0=17"), HasSubstr("within ±16"));
  EXPECT_THAT(refusal("0=0,17"), HasSubstr("view is 0,17, expected numbers within ±16"));
  EXPECT_THAT(refusal("0=nan"), HasSubstr("within ±16"));
  EXPECT_THAT(refusal("5=0,5=1"), HasSubstr("grow"));
  EXPECT_THAT(refusal("-1=0"), HasSubstr("from 0"));
}

}  // namespace
}  // namespace vantage
