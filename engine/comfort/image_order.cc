#include "engine/comfort/image_order.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <type_traits>
#include <variant>
#include <vector>

namespace vantage {
namespace {

constexpr int kMinHidden_px = 4;
constexpr double kMinStep_px = 3;
constexpr int kCompared_px = 4;     // at most, on each side of an end
constexpr double kClearLevels = 8;  // of 255

template <typename T>
void luma_row(const Image<T>& image, int y, std::vector<double>& luma) {
  const double scale = std::is_same_v<T, std::uint8_t>    ? 1.0
                       : std::is_same_v<T, std::uint16_t> ? 255.0 / 65535.0
                                                          : 255.0;
  for (int x = 0; x < image.width(); ++x) {
    const double first = static_cast<double>(image.at(x, y, 0));
    luma[static_cast<std::size_t>(x)] =
        scale * (image.channels() < 3
                     ? first
                     : 0.299 * first + 0.587 * static_cast<double>(image.at(x, y, 1)) +
                           0.114 * static_cast<double>(image.at(x, y, 2)));
  }
}

double mean_of(const std::vector<double>& luma, int first, int end) {
  double sum = 0;
  for (int x = first; x < end; ++x) {
    sum += luma[static_cast<std::size_t>(x)];
  }
  return sum / std::max(1, end - first);
}

/// Hidden pixels [first, end) of a row, with matched ones on both sides.
void vote(const std::vector<double>& luma, int first, int end, bool far_is_left,
          OrderVotes& votes) {
  const int hidden = end - first;
  const int inside = std::min(kCompared_px, hidden / 2);
  const auto width = static_cast<int>(luma.size());
  // Edges are a pixel or two wide: the pixel at each end is left out.
  const double at_left = std::abs(mean_of(luma, first + 1, first + 1 + inside) -
                                  mean_of(luma, std::max(0, first - 1 - inside), first - 1));
  const double at_right = std::abs(mean_of(luma, end - 1 - inside, end - 1) -
                                   mean_of(luma, end + 1, std::min(width, end + 1 + inside)));
  if (std::abs(at_left - at_right) < kClearLevels) {
    return;
  }
  const bool continues_left = at_left < at_right;
  ++(continues_left == far_is_left ? votes.right : votes.wrong);
}

}  // namespace

OrderVotes order_of_images(const Photograph& image, const MatchedMap& map, Side side) {
  OrderVotes votes;
  const int width = map.disparity_px.width();
  if (map.unmatched.empty()) {
    return votes;
  }
  std::vector<double> luma(static_cast<std::size_t>(width));
  for (int y = 0; y < map.disparity_px.height(); ++y) {
    std::visit([&](const auto& pixels) { luma_row(pixels, y, luma); }, image.pixels);
    const std::uint8_t* hidden = map.unmatched.row(y);
    const float* d = map.disparity_px.row(y);
    for (int first = 3; first < width - 3;) {
      if (hidden[first] == 0 || hidden[first - 1] != 0) {
        ++first;
        continue;
      }
      int end = first;
      while (end < width && hidden[end] != 0) {
        ++end;
      }
      if (end < width - 3 && end - first >= kMinHidden_px) {
        const double step = static_cast<double>(d[end]) - static_cast<double>(d[first - 1]);
        // In the left image hidden pixels are left of what is near, in the right one right of it.
        const double expected = side == Side::kLeft ? step : -step;
        const int length = end - first;
        if (expected >= kMinStep_px && length >= expected / 2 && length <= 2 * expected) {
          vote(luma, first, end, side == Side::kLeft, votes);
        }
      }
      first = end;
    }
  }
  return votes;
}

}  // namespace vantage
