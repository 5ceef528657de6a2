// Matches a pair in memory by C++: a random texture, seen 7 px apart. Yours comes from cameras or
// files.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <random>
#include <vector>

#include <vantage.h>

namespace {

constexpr int kWidth = 240;
constexpr int kHeight = 160;
constexpr int kShift_px = 7;

}  // namespace

int main() try {
  std::vector<std::uint16_t> left(kWidth * kHeight);
  std::vector<std::uint16_t> right(kWidth * kHeight);
  std::mt19937 random(1);
  for (auto& value : left) {
    value = static_cast<std::uint16_t>(random() >> 16U);
  }
  for (std::size_t i = kShift_px; i < left.size(); ++i) {
    right[i - kShift_px] = left[i];
  }

  const vantage::v0::Matcher matcher;  // finds the range; keep it from pair to pair
  const auto pair =
      matcher.match(vantage::v0::Image<const std::uint16_t>{left.data(), kWidth, kHeight},
                    vantage::v0::Image<const std::uint16_t>{right.data(), kWidth, kHeight});
  for (const vantage::v0::Remark& remark : pair.remarks()) {
    std::printf("%s: %s\n", remark.is_warning ? "warning" : "note", remark.text.c_str());
  }
  std::vector<float> disparity_px(left.size());
  pair.disparity(VANTAGE_LEFT, {disparity_px.data(), kWidth, kHeight});
  std::vector<std::uint16_t> view(left.size());
  pair.view(0.5, 0, vantage::v0::Image<std::uint16_t>{view.data(), kWidth, kHeight});
  const float middle_px = disparity_px[kHeight / 2 * kWidth + kWidth / 2];
  std::printf("disparity in the middle: %.2f px\n", middle_px);
  return std::abs(middle_px - kShift_px) < 0.5F ? 0 : 1;
} catch (const vantage::v0::Error& error) {
  std::fprintf(stderr, "error: %s\n", error.what());
  return error.status();
}
