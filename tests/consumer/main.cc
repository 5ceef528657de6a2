// Matches a generated pair in memory with the installed library and checks the disparity.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <random>
#include <vector>

#include "engine/vantage.h"

namespace {

constexpr int kWidth = 97;
constexpr int kHeight = 61;
constexpr int kDisparityPx = 5;
/// Bytes from row to row: BGR, and some that belong to no pixel.
constexpr std::ptrdiff_t kRowBytes = 3 * kWidth + 13;

vantage::Photograph photograph(const std::vector<std::uint8_t>& bytes) {
  return vantage::photograph_of(
      vantage::PixelBuffer<std::uint8_t>{.data = bytes.data(),
                                         .width_px = kWidth,
                                         .height_px = kHeight,
                                         .channels = 3,
                                         .row_bytes = kRowBytes,
                                         .order = vantage::ChannelOrder::kBgr});
}

}  // namespace

int main() {
  std::vector<std::uint8_t> left(static_cast<std::size_t>(kRowBytes * kHeight));
  std::vector<std::uint8_t> right(left.size());
  std::mt19937 random(1);
  for (std::uint8_t& byte : left) {
    byte = static_cast<std::uint8_t>(random() >> 24U);
  }
  for (std::size_t i = 0; i + 3 * kDisparityPx < left.size(); ++i) {
    right[i] = left[i + 3 * kDisparityPx];
  }

  vantage::MatchOptions options;
  options.disparities_auto = true;
  const vantage::PairMatcher matcher(options);
  vantage::MatchedMap map;
  const vantage::DisparityRange range =
      matcher.match(photograph(left), photograph(right), map).disparities;

  int wrong = 0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = kDisparityPx + 3; x < kWidth - 3; ++x) {
      const float error_px = std::abs(map.disparity_px.at(x, y) - float{kDisparityPx});
      wrong += error_px <= 0.25F ? 0 : 1;  // NaN, an unknown disparity, counts as wrong
    }
  }
  // Depths and points of a rig of 100 px focal length and 0.1 m between the cameras.
  const vantage::MapCamera camera{.scale = {.focal_length_px = 100, .baseline = 0.1}};
  vantage::Execution& execution = vantage::default_execution();
  vantage::Image<float> depth_m;
  vantage::depth_map(map.disparity_px.view(), camera.scale, vantage::kNoMaxDepth, execution,
                     depth_m);
  const bool is_deep =
      std::abs(depth_m.at(kWidth / 2, kHeight / 2) - 100 * 0.1 / kDisparityPx) < 0.2;
  const vantage::Photograph colours = photograph(left);
  const vantage::PointCloud cloud = vantage::point_cloud({.disparity_px = map.disparity_px.view(),
                                                          .colours = &colours,
                                                          .unmatched = map.unmatched.view(),
                                                          .camera = camera},
                                                         {}, execution);
  std::printf("consumer: %zu points, %zu bytes of PLY\n", cloud.size(),
              vantage::encode_ply(cloud, vantage::kCameraFrame).size());

  std::printf("consumer: disparities %d:%d, %d of %d pixels off the true disparity of %d px\n",
              range.min, range.max, wrong, (kWidth - kDisparityPx - 6) * kHeight, kDisparityPx);
  return wrong == 0 && is_deep ? 0 : 1;
}
