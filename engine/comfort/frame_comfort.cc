#include "engine/comfort/frame_comfort.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <type_traits>
#include <vector>

#include "engine/comfort/image_order.h"
#include "engine/rectification/rows/row_check.h"

namespace vantage {
namespace {

/// A border is what is nearer to it than this share of the width.
constexpr double kBorderShare = 0.01;
/// Nearer to the screen than this share of the width counts as on it.
constexpr double kInFrontShare = 0.002;
constexpr int kColourStep_px = 4;

int in_units(double value, int per_one) { return static_cast<int>(std::lround(value * per_one)); }

bool is_matched(const MatchedMap& map, int x, int y) {
  return std::isfinite(map.disparity_px.at(x, y)) &&
         (map.unmatched.empty() || map.unmatched.at(x, y) == 0);
}

/// Disparities counted in units of 1/kComfortPerPixel px.
class DisparityCounts {
 public:
  explicit DisparityCounts(const MatchedMap& map) {
    const ImageView<const float> all = map.disparity_px.view();
    int min = 0;
    int max = -1;
    for_matched(map, [&](int, int, int disparity) {
      min = max < min ? disparity : std::min(min, disparity);
      max = max < min ? disparity : std::max(max, disparity);
    });
    min_ = min;
    counts_.resize(static_cast<std::size_t>(std::max(0, max - min + 1)));
    for_matched(map, [&](int, int, int disparity) {
      ++counts_[static_cast<std::size_t>(disparity - min_)];
      ++total_;
    });
    pixels_ = static_cast<std::int64_t>(all.width()) * all.height();
  }

  [[nodiscard]] std::int64_t total() const { return total_; }
  [[nodiscard]] int matched_share() const {
    return static_cast<int>(total_ * kComfortWhole / std::max<std::int64_t>(1, pixels_));
  }
  /// The disparities that the shares of pixels have at most.
  [[nodiscard]] std::array<int, kComfortShares.size()> quantiles() const {
    std::array<int, kComfortShares.size()> values = {};
    std::size_t bin = 0;
    std::int64_t passed = counts_.empty() ? 0 : counts_.front();
    for (std::size_t i = 0; total_ > 0 && i < values.size(); ++i) {
      const auto place = static_cast<std::int64_t>(
          std::llround(kComfortShares[i] * static_cast<double>(total_ - 1)));
      while (passed <= place) {
        passed += counts_[++bin];
      }
      values[i] = min_ + static_cast<int>(bin);
    }
    return values;
  }

 private:
  template <typename Use>
  static void for_matched(const MatchedMap& map, const Use& use) {
    for (int y = 0; y < map.disparity_px.height(); ++y) {
      for (int x = 0; x < map.disparity_px.width(); ++x) {
        if (is_matched(map, x, y)) {
          use(x, y, in_units(map.disparity_px.at(x, y), kComfortPerPixel));
        }
      }
    }
  }

  int min_ = 0;
  std::vector<std::int64_t> counts_;
  std::int64_t total_ = 0;
  std::int64_t pixels_ = 0;
};

/// A border cuts what is in front of the screen where the eye on the other side sees it at the
/// border: at the left one the right eye, in whose image it touches the border.
std::array<FrameComfort::Border, 2> cut_at_borders(const MatchedMap& map, Side side) {
  const int width = map.disparity_px.width();
  const int height = map.disparity_px.height();
  const double border = std::max(2.0, kBorderShare * width);
  const double in_front = std::max(1.0, kInFrontShare * width);
  std::array<FrameComfort::Border, 2> borders = {};
  for (int y = 0; y < height; ++y) {
    std::array<float, 2> nearest = {};
    for (int x = 0; x < width; ++x) {
      const float d = map.disparity_px.at(x, y);
      if (!is_matched(map, x, y) || d < in_front) {
        continue;
      }
      const double left_x = side == Side::kLeft ? x : x + static_cast<double>(d);
      const double right_x = left_x - static_cast<double>(d);
      if (right_x < border) {
        nearest[0] = std::max(nearest[0], d);
      }
      if (left_x > width - 1 - border) {
        nearest[1] = std::max(nearest[1], d);
      }
    }
    for (std::size_t i = 0; i < 2; ++i) {
      borders[i].rows += nearest[i] > 0 ? 1 : 0;
      borders[i].disparity = std::max(borders[i].disparity,
                                      in_units(static_cast<double>(nearest[i]), kComfortPerPixel));
    }
  }
  for (FrameComfort::Border& one : borders) {
    one.rows = one.rows * kComfortWhole / std::max(1, height);
  }
  return borders;
}

template <typename T>
double in_grey_levels(T value) {
  if constexpr (std::is_same_v<T, std::uint8_t>) {
    return value;
  } else if constexpr (std::is_same_v<T, std::uint16_t>) {
    return value * (255.0 / 65535.0);
  } else {
    return 255.0 * static_cast<double>(value);
  }
}

template <typename T>
std::array<int, 3> colour_difference(const Image<T>& left, const Image<T>& right,
                                     const MatchedMap& map, Side side) {
  std::array<double, 3> sums = {};
  int count = 0;
  const int channels = left.channels();
  for (int y = 0; y < left.height(); y += kColourStep_px) {
    for (int x = 0; x < left.width(); x += kColourStep_px) {
      if (!is_matched(map, x, y)) {
        continue;
      }
      const auto d = static_cast<int>(std::lround(map.disparity_px.at(x, y)));
      const int left_x = side == Side::kLeft ? x : x + d;
      const int right_x = left_x - d;
      if (std::min(left_x, right_x) < 0 || std::max(left_x, right_x) >= left.width()) {
        continue;
      }
      ++count;
      for (int c = 0; c < 3; ++c) {
        const int channel = channels >= 3 ? c : 0;
        sums[static_cast<std::size_t>(c)] += in_grey_levels(left.at(left_x, y, channel)) -
                                             in_grey_levels(right.at(right_x, y, channel));
      }
    }
  }
  std::array<int, 3> means = {};
  for (std::size_t c = 0; count > 0 && c < 3; ++c) {
    means[c] = in_units(sums[c] / count, kComfortPerGreyLevel);
  }
  return means;
}

}  // namespace

FrameComfort measure_comfort(const Photograph& left, const Photograph& right, const MatchedMap& map,
                             Side side) {
  const DisparityCounts counts(map);
  FrameComfort comfort{.width_px = left.width(),
                       .height_px = left.height(),
                       .matched = counts.matched_share(),
                       .disparity = counts.quantiles(),
                       .borders = cut_at_borders(map, side),
                       .vertical = std::nullopt,
                       .order_right = 0,
                       .order_wrong = 0,
                       .colour = {}};
  if (const auto vertical = check_rectification(left, right)) {
    comfort.vertical = {in_units(vertical->mean_px, kComfortPerPixel),
                        in_units(vertical->systematic_px, kComfortPerPixel)};
  }
  const OrderVotes votes = order_of_images(side == Side::kLeft ? left : right, map, side);
  comfort.order_right = votes.right;
  comfort.order_wrong = votes.wrong;
  comfort.colour = std::visit(
      [&](const auto& left_image) {
        using Pixels = std::remove_cvref_t<decltype(left_image)>;
        return colour_difference(left_image, std::get<Pixels>(right.pixels), map, side);
      },
      left.pixels);
  return comfort;
}

}  // namespace vantage
