#include "engine/sequence/past/flicker.h"

#include "tests/engine/engine_test.h"
#include "tests/engine/plain_still_pixels.h"

namespace vantage::flicker_test {

constexpr int kWidth = 61;
constexpr int kHeight = 37;

struct MadeUpFrame {
  Photograph left;
  DisparityMap map;
  std::vector<Photograph> views;

  [[nodiscard]] const Image<std::uint8_t>& grey(const Photograph& photograph) const {
    return std::get<Image<std::uint8_t>>(photograph.pixels);
  }
};

/// A still texture, but for a square that is different in each frame; map and views with noise.
MadeUpFrame make_frame(int frame, const std::vector<double>& views_x) {
  MadeUpFrame made;
  Image<std::uint8_t> left(kWidth, kHeight);
  made.map.resize(kWidth, kHeight);
  std::mt19937 still(1);
  std::mt19937 random(static_cast<unsigned>(100 + frame));
  for (const auto [x, y] : positions_of(kWidth, kHeight)) {
    const auto level = static_cast<std::uint8_t>(still() % 200);
    const bool changes = x >= 25 && x < 31 && y >= 10 && y < 19;
    left.at(x, y) = changes ? static_cast<std::uint8_t>(random()) : level;
    made.map.at(x, y) = random() % 30 == 0
                            ? kUnknown
                            : 4 + static_cast<float>(y / 10) + static_cast<float>(random() % 4) / 2;
  }
  for (std::size_t v = 0; v < views_x.size(); ++v) {
    Image<std::uint8_t> view(kWidth, kHeight);
    for (const auto [x, y] : positions_of(kWidth, kHeight)) {
      view.at(x, y) = static_cast<std::uint8_t>(random() % 9 + 40 * v);
    }
    made.views.push_back({std::move(view)});
  }
  made.left = {std::move(left)};
  return made;
}

FlickerSums add(FlickerMeter& meter, const MadeUpFrame& frame, const std::vector<double>& views_x,
                Execution& execution) {
  std::vector<ViewOfFrame> views;
  for (std::size_t v = 0; v < frame.views.size(); ++v) {
    views.push_back({BaselinePosition{views_x[v], 0}, &frame.views[v]});
  }
  return meter.add(frame.left, frame.map.view(), views, execution);
}

bool is_still(const MadeUpFrame& a, const MadeUpFrame& b, int x, int y) {
  return test::is_still(a.grey(a.left), b.grey(b.left), x, y, 3);
}

FlickerSums plain_sums(const MadeUpFrame& a, const MadeUpFrame& b,
                       const std::vector<double>& views_x) {
  FlickerSums sums;
  sums.clear(views_x.size());
  sums.frames = 1;
  sums.pixels = kWidth * kHeight;
  for (int y = 0; y < kHeight; ++y) {
    float min = 1e9F;
    float max = -1e9F;
    for (int x = 0; x < kWidth; ++x) {
      const float before = a.map.at(x, y);
      const float now = b.map.at(x, y);
      for (const float d : {before, now}) {
        min = std::isnan(d) ? min : std::min(min, d);
        max = std::isnan(d) ? max : std::max(max, d);
      }
      if (!is_still(a, b, x, y)) {
        continue;
      }
      ++sums.still;
      sums.grey_change += std::abs(b.grey(b.left).at(x, y) - a.grey(a.left).at(x, y));
      if (!std::isnan(before) && !std::isnan(now)) {
        ++sums.compared;
        sums.jumped += std::abs(now - before) > 1 ? 1 : 0;
        sums.disparity_change += std::lround(std::abs(now - before) * 1024);
      }
    }
    for (std::size_t v = 0; v < views_x.size(); ++v) {
      const double first = std::floor(std::min(views_x[v] * min, views_x[v] * max));
      const double last = std::ceil(std::max(views_x[v] * min, views_x[v] * max));
      for (int x = 0; x < kWidth; ++x) {
        bool is_compared = false;
        for (int s = static_cast<int>(first); s <= static_cast<int>(last); ++s) {
          if (x + s < 0 || x + s >= kWidth) {
            continue;
          }
          is_compared = is_still(a, b, x + s, y);
          if (!is_compared) {
            break;
          }
        }
        if (is_compared) {
          ++sums.views[v].compared;
          sums.views[v].grey_change +=
              std::abs(b.grey(b.views[v]).at(x, y) - a.grey(a.views[v]).at(x, y));
        }
      }
    }
  }
  const auto mean = [](const Image<std::uint8_t>& image) {
    double sum = 0;
    for (const auto [x, y] : positions_of(kWidth, kHeight)) {
      sum += image.at(x, y);
    }
    return sum / (kWidth * kHeight);
  };
  for (std::size_t v = 0; v < views_x.size(); ++v) {
    const double of_view = mean(b.grey(b.views[v])) - mean(a.grey(a.views[v]));
    const double of_left = mean(b.grey(b.left)) - mean(a.grey(a.left));
    sums.views[v].brightness_jump = std::lround(std::abs(of_view - of_left) * 1024);
  }
  return sums;
}

TEST(FlickerMeter, FollowsTheDefinitions) {
  const std::vector<double> views_x = {0.5, -0.75, 1.5, 0};
  Execution serial({.executor = scheduler::ExecutorKind::kSerial});
  FlickerMeter meter(3);
  FlickerMeter other_meter(3);
  FlickerSums nothing;
  nothing.clear(views_x.size());
  MadeUpFrame before = make_frame(0, views_x);
  EXPECT_EQ(add(meter, before, views_x, execution()), nothing);
  EXPECT_EQ(add(other_meter, before, views_x, serial), nothing);
  for (int frame = 1; frame < 4; ++frame) {
    MadeUpFrame now = make_frame(frame, views_x);
    const FlickerSums sums = add(meter, now, views_x, execution());
    const FlickerSums expected = plain_sums(before, now, views_x);
    for (std::size_t v = 0; v < views_x.size(); ++v) {
      EXPECT_EQ(sums.views[v].compared, expected.views[v].compared) << v;
      EXPECT_EQ(sums.views[v].grey_change, expected.views[v].grey_change) << v;
      EXPECT_EQ(sums.views[v].brightness_jump, expected.views[v].brightness_jump) << v;
    }
    EXPECT_EQ(sums, expected);
    EXPECT_GT(expected.views[0].compared, 0);
    EXPECT_LT(expected.views[0].compared, expected.still);
    EXPECT_EQ(add(other_meter, now, views_x, serial), expected);
    before = std::move(now);
  }
}

TEST(FlickerMeter, FramesOfOneScene) {
  FlickerMeter meter(3);
  const MadeUpFrame frame = make_frame(0, {0.5});
  add(meter, frame, {0.5}, execution());
  FlickerSums sums = add(meter, frame, {0.5}, execution());
  EXPECT_EQ(sums.still, kWidth * kHeight);
  EXPECT_GT(sums.compared, 0);
  EXPECT_EQ(sums.disparity_change, 0);
  EXPECT_EQ(sums.views[0].grey_change, 0);
  EXPECT_EQ(sums.views[0].brightness_jump, 0);
  // A view from elsewhere is another view.
  sums = add(meter, frame, {0.25}, execution());
  EXPECT_GT(sums.compared, 0);
  EXPECT_EQ(sums.views[0], ViewFlickerSums{});
  meter.restart();
  EXPECT_EQ(add(meter, frame, {0.25}, execution()).frames, 0);
  EXPECT_EQ(add(meter, frame, {0.25}, execution()).frames, 1);
}

TEST(FlickerMeter, WhatCannotBeCompared) {
  FlickerMeter meter(3);
  const MadeUpFrame frame = make_frame(0, {});
  add(meter, frame, {}, execution());
  Photograph small{Image<std::uint8_t>(5, 4)};
  std::get<Image<std::uint8_t>>(small.pixels).fill(7);
  EXPECT_EQ(meter.add(small, {}, {}, execution()).frames, 0);
  const FlickerSums sums = meter.add(small, {}, {}, execution());
  EXPECT_EQ(sums.still, 20);
  EXPECT_EQ(sums.compared, 0);
  EXPECT_EQ(sums.mean_disparity_change_px(), 0);
  EXPECT_THROW(meter.add(small, frame.map.view(), {}, execution()), Error);
  const ViewOfFrame view{BaselinePosition{0.5, 0}, &frame.left};
  EXPECT_THROW(meter.add(small, {}, {&view, 1}, execution()), Error);
  EXPECT_THROW(FlickerMeter(-1), UsageError);
}

TEST(FlickerMeter, CamerasMayHaveASizeOfTheirOwn) {
  FlickerMeter meter(3);
  const MadeUpFrame frame = make_frame(0, {});
  Photograph view{Image<std::uint8_t>(10, 6)};
  auto& levels = std::get<Image<std::uint8_t>>(view.pixels);
  const auto sums_at = [&](std::uint8_t level, const ViewPose& pose) {
    levels.fill(level);
    const ViewOfFrame of_frame{pose, &view};
    return meter.add(frame.left, frame.map.view(), {&of_frame, 1}, execution());
  };
  PosedCamera camera;
  sums_at(100, camera);
  const FlickerSums brighter = sums_at(103, camera);
  EXPECT_EQ(brighter.views[0].compared, 0);
  EXPECT_EQ(brighter.views[0].mean_brightness_jump(1), 3);
  camera.translation.x() = 1;
  EXPECT_EQ(sums_at(200, camera).views[0].brightness_jump, 0);
}

TEST(FlickerSums, AddUpInAnyOrder) {
  const std::vector<double> views_x = {0.5};
  FlickerMeter meter(3);
  std::vector<FlickerSums> frames;
  for (int frame = 0; frame < 4; ++frame) {
    frames.push_back(add(meter, make_frame(frame, views_x), views_x, execution()));
  }
  FlickerSums forward;
  FlickerSums backward;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    forward.add(frames[k]);
    backward.add(frames[frames.size() - 1 - k]);
  }
  EXPECT_EQ(forward, backward);
  EXPECT_EQ(forward.frames, 3);
  EXPECT_DOUBLE_EQ(
      forward.mean_disparity_change_px(),
      static_cast<double>(forward.disparity_change) / 1024 / static_cast<double>(forward.compared));
  EXPECT_GT(forward.share_jumped(), 0);
  EXPECT_LT(forward.share_compared(), 1);
  EXPECT_GT(forward.views[0].mean_grey_change(), 2);
  EXPECT_GT(forward.views[0].mean_brightness_jump(forward.frames), 0);
  FlickerSums two;
  two.clear(2);
  EXPECT_THROW(forward.add(two), Error);
}

}  // namespace vantage::flicker_test
