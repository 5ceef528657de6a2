// Repetitive texture on a slanted surface: a carpet whose weave repeats every few pixels and whose
// disparity grows towards the camera. Coarse pixels cover several disparities of it.

#include "engine/matching/stereo_matcher.h"

#include "tests/engine/engine_test.h"

namespace vantage::repetitive_floor_test {

constexpr int kWidth = 320;
constexpr int kHeight = 240;
constexpr int kSamples = 3;  ///< per pixel and direction
constexpr double kFarPx = 15;
constexpr double kNearPx = 40;

double disparity_at(double y) { return kFarPx + (kNearPx - kFarPx) * y / (kHeight - 1); }

/// Random values on a grid, linear between them.
class Irregularity {
 public:
  explicit Irregularity(std::mt19937& random) : values_(kSide * kSide) {
    for (double& value : values_) {
      value = static_cast<double>(random() % 20001) / 10000 - 1;
    }
  }
  [[nodiscard]] double at(double u, double v) const {
    const double left = std::floor(u);
    const double top = std::floor(v);
    const auto value = [&](int du, int dv) {
      const auto wrapped = [](double coordinate) {
        return static_cast<std::size_t>(static_cast<long>(coordinate) % kSide + kSide) % kSide;
      };
      return values_[wrapped(top + dv) * kSide + wrapped(left + du)];
    };
    const double a = u - left;
    const double b = v - top;
    return (1 - b) * ((1 - a) * value(0, 0) + a * value(1, 0)) +
           b * ((1 - a) * value(0, 1) + a * value(1, 1));
  }

 private:
  static constexpr std::size_t kSide = 256;
  std::vector<double> values_;
};

/// Grey level of the floor seen by the left (0) or right camera (1) at a point of its image.
double grey_at(double x, double y, int camera, const Irregularity& irregularity) {
  constexpr double kPeriod = 5.3;
  constexpr double kDepth = 7;  ///< stretches the weave along the viewing direction
  const double disparity = disparity_at(y);
  const double across = (x + camera * disparity - 0.5 * kWidth) * kNearPx / disparity;
  const double ahead = kDepth * kNearPx * kNearPx / disparity;
  const double turn = 2 * std::numbers::pi / kPeriod;
  return 110 + 35 * std::cos(turn * across) * std::cos(turn * ahead) +
         20 * irregularity.at(across / 2 + 9, ahead / 2);
}

Photograph photographed(int camera, const Irregularity& irregularity, std::mt19937& random) {
  Image<std::uint8_t> image(kWidth, kHeight);
  for (const auto [x, y] : positions_of(kWidth, kHeight)) {
    double sum = 0;
    for (int i = 0; i < kSamples * kSamples; ++i) {
      sum += grey_at(x + (i % kSamples + 0.5) / kSamples - 0.5,
                     y + (i / kSamples + 0.5) / kSamples - 0.5, camera, irregularity);
    }
    const double noise = static_cast<double>(random() % 7) - 3;
    image.at(x, y) = static_cast<std::uint8_t>(
        std::clamp(std::lround(sum / (kSamples * kSamples) + noise), 0L, 255L));
  }
  return {std::move(image)};
}

double bad_percent(const DisparityMap& map) {
  int bad = 0;
  int pixels = 0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = static_cast<int>(std::ceil(disparity_at(y))); x < kWidth; ++x) {
      ++pixels;
      bad += std::abs(map.at(x, y) - disparity_at(y)) <= 2 ? 0 : 1;
    }
  }
  return 100.0 * bad / pixels;
}

TEST(RepetitiveFloor, IsFoundByThePresets) {
  std::mt19937 random(1);
  const Irregularity irregularity(random);
  const Photograph left = photographed(0, irregularity, random);
  const Photograph right = photographed(1, irregularity, random);
  for (const MatchPreset preset : {MatchPreset::kBalanced, MatchPreset::kQuality}) {
    MatchOptions options;
    options.preset = preset;
    options.disparities = {0, 47};
    const auto bad_with = [&](std::optional<double> slant_penalty) {
      options.parameters.slant_penalty = slant_penalty;
      DisparityMaps maps;
      StereoMatcher(options, execution()).match(left, right, {.right = false}, maps);
      return bad_percent(maps.left.disparity_px);
    };
    EXPECT_LT(bad_with(std::nullopt), 2);
    // The scene tells the two apart: without slants the wrong period wins.
    EXPECT_GT(bad_with(std::numeric_limits<double>::infinity()), 10);
  }
}

}  // namespace vantage::repetitive_floor_test
