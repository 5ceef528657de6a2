#include "engine/view_geometry/view_pose.h"

#include "tests/engine/engine_test.h"

#include <Eigen/Geometry>

namespace vantage::view_path_test {

std::string refusal(std::string_view text) {
  return error_of([&] { parse_view_path(text).validate(); });
}

BaselinePosition position_at(const ViewPath& path, int frame) {
  return std::get<BaselinePosition>(path.at(frame));
}

PosedCamera camera_at(double x, double angle) {
  PosedCamera camera{.width_px = 64, .height_px = 48};
  camera.matrix << 70, 0, 31, 0, 72, 22, 0, 0, 1;
  camera.rotation = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitY()).matrix();
  camera.translation = -camera.rotation * Eigen::Vector3d(x, 0, 0);
  return camera;
}

TEST(ViewPath, IsLinearBetweenKeysAndStillOutside) {
  const ViewPath path = parse_view_path("10=0,20=1,24=-1");
  EXPECT_TRUE(path.moves());
  EXPECT_EQ(path.frames(), 25);
  EXPECT_EQ(position_at(path, 0).x, 0);
  EXPECT_EQ(position_at(path, 10).x, 0);
  EXPECT_DOUBLE_EQ(position_at(path, 13).x, 0.3);
  EXPECT_EQ(position_at(path, 20).x, 1);
  EXPECT_DOUBLE_EQ(position_at(path, 21).x, 0.5);
  EXPECT_EQ(position_at(path, 24).x, -1);
  EXPECT_EQ(position_at(path, 1000000).x, -1);
  EXPECT_EQ(position_at(path, 21).y, 0);
  const ViewPath fixed = ViewPath::fixed(BaselinePosition{0.25, 1});
  EXPECT_FALSE(fixed.moves());
  EXPECT_EQ(position_at(fixed, 7), (BaselinePosition{0.25, 1}));
}

TEST(ViewPath, KeysMayLeaveTheBaseline) {
  const ViewPath path = parse_view_path("0=0.5,-1,4=0.5,8=1,2");
  EXPECT_EQ(position_at(path, 0), (BaselinePosition{0.5, -1}));
  EXPECT_EQ(position_at(path, 2), (BaselinePosition{0.5, -0.5}));
  EXPECT_EQ(position_at(path, 4), (BaselinePosition{0.5, 0}));
  EXPECT_EQ(position_at(path, 6), (BaselinePosition{0.75, 1}));
}

TEST(ViewPath, CamerasMoveAndTurnBetweenTheirKeys) {
  const ViewPath path{{{2, camera_at(0, 0)}, {6, camera_at(1, 0.4)}}};
  path.validate();
  EXPECT_EQ(path.at(0), ViewPose(camera_at(0, 0)));
  EXPECT_EQ(path.at(60), ViewPose(camera_at(1, 0.4)));
  const auto between = std::get<PosedCamera>(path.at(3));
  const PosedCamera expected = camera_at(0.25, 0.1);
  EXPECT_LT((between.rotation - expected.rotation).norm(), 1e-12);
  EXPECT_LT((between.centre() - expected.centre()).norm(), 1e-12);
}

TEST(ViewPath, TextBringsBackTheSame) {
  for (const char* text : {"0=0.5", "0=0,48=1,96=0", "3=-0.1,4=1e-3", "0=1,-2,5=0,7=0.5,1e-3"}) {
    const ViewPath path = parse_view_path(text);
    EXPECT_EQ(parse_view_path(to_string(path)), path) << text;
  }
}

TEST(ViewPath, RefusesWhatIsNoPath) {
  for (const char* text : {"", "0", "=1", "0=", "a=1", "0=1,", "0=1;2=3", "0.5=1", "0=1 ,2=3",
                           "2,0=1", "0=1,2,3", "0=1,"}) {
    EXPECT_THAT(refusal(text), HasSubstr("expected keys FRAME=XS")) << text;
  }
  EXPECT_EQ(refusal("5=0,5=1"),
            "view path has frame 5 as key 2, expected frames from 0 that grow from key to key");
  EXPECT_THAT(refusal("-1=0"), HasSubstr("from 0"));
  EXPECT_EQ(error_of([] { ViewPath{}.validate(); }),
            "view path is empty, expected at least one pose");
}

TEST(ViewPath, OfTwoKindsOrSizesIsRefused) {
  const ViewPath mixed{{{0, BaselinePosition{}}, {1, camera_at(0, 0)}}};
  EXPECT_EQ(error_of([&] { mixed.validate(); }),
            "view path has positions on the baseline and cameras, expected poses of one kind");
  PosedCamera other = camera_at(0, 0);
  other.width_px = 100;
  const ViewPath sizes{{{0, camera_at(0, 0)}, {1, other}}};
  EXPECT_EQ(error_of([&] { sizes.validate(); }),
            "view path has cameras of 64×48 and 100×48, expected one size");
  other.width_px = 0;
  other.height_px = 0;
  const ViewPath some{{{0, camera_at(0, 0)}, {1, other}}};
  EXPECT_EQ(error_of([&] { some.validate(); }),
            "view path has cameras with and without a size, expected it for all or for none");
}

}  // namespace vantage::view_path_test
