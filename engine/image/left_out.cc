#include "engine/image/left_out.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <utility>
#include <variant>
#include <vector>

namespace vantage {
namespace {

constexpr std::uint8_t kSet = 255;

/// False, and nothing is written, if the row shows no scene.
template <typename T>
bool fill_row(const std::uint8_t* left_out, int width, int channels, T* row) {
  const auto copy = [&](int from, int to) {
    std::copy_n(row + from * channels, channels, row + to * channels);
  };
  int last = -1;  // that shows the scene
  for (int x = 0; x < width; ++x) {
    if (left_out[x] != 0) {
      continue;
    }
    for (int gap = last + 1; gap < x; ++gap) {
      copy(last >= 0 && gap - last <= x - gap ? last : x, gap);
    }
    last = x;
  }
  for (int gap = last + 1; last >= 0 && gap < width; ++gap) {
    copy(last, gap);
  }
  return last >= 0;
}

template <typename T>
void fill_image(const Mask& left_out, Image<T>& image) {
  const auto width = static_cast<std::size_t>(image.width());
  std::vector<int> filled;
  std::vector<int> empty;
  for (int y = 0; y < image.height(); ++y) {
    const bool is_filled = std::memchr(left_out.row(y), kSet, width) == nullptr ||
                           fill_row(left_out.row(y), image.width(), image.channels(), image.row(y));
    (is_filled ? filled : empty).push_back(y);
  }
  for (const int y : filled.empty() ? std::vector<int>() : empty) {
    const int nearest =
        *std::ranges::min_element(filled, {}, [&](int row) { return std::abs(row - y); });
    std::copy_n(image.row(nearest), image.width() * image.channels(), image.row(y));
  }
}

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

template <typename T>
void erase(const Mask& left_out, T unknown, Execution& execution, Image<T>& image) {
  if (image.empty() || left_out.empty()) {
    return;
  }
  execution.for_each_row(image.height(), [&](int y) {
    const std::uint8_t* const is_left_out = left_out.row(y);
    for (int x = 0; x < image.width(); ++x) {
      image.at(x, y) = is_left_out[x] != 0 ? unknown : image.at(x, y);
    }
  });
}

}  // namespace

void leave_out(Photograph& photograph, Mask left_out) {
  if (!left_out.empty()) {
    std::visit([&](auto& image) { fill_image(left_out, image); }, photograph.pixels);
  }
  photograph.left_out = std::move(left_out);
}

void blacken_left_out(Photograph& photograph) {
  std::visit(
      [&]<typename T>(Image<T>& image) {
        for (int y = 0; y < photograph.left_out.height(); ++y) {
          for (int x = 0; x < image.width(); ++x) {
            if (photograph.left_out.at(x, y) != 0) {
              std::fill_n(image.row(y) + x * image.channels(), image.channels(), T{0});
            }
          }
        }
      },
      photograph.pixels);
}

Mask of_either(Mask one, const Mask& other) {
  if (one.empty()) {
    return other.copy();
  }
  for (int y = 0; y < other.height(); ++y) {
    std::transform(other.row(y), other.row(y) + other.width(), one.row(y), one.row(y),
                   [](std::uint8_t a, std::uint8_t b) { return std::max(a, b); });
  }
  return one;
}

void halve(const Mask& left_out, Execution& execution, Mask& half) {
  half.resize((left_out.width() + 1) / 2, (left_out.height() + 1) / 2);
  execution.for_each_row(half.height(), [&](int y) {
    const std::uint8_t* const upper = left_out.row(2 * y);
    const std::uint8_t* const lower = left_out.row(std::min(2 * y + 1, left_out.height() - 1));
    for (int x = 0; x < half.width(); ++x) {
      const int right = std::min(2 * x + 1, left_out.width() - 1);
      half.at(x, y) = upper[2 * x] & upper[right] & lower[2 * x] & lower[right];
    }
  });
}

void erase_left_out(const Mask& left_out, Execution& execution, MatchedMap& map) {
  erase(left_out, kNaN, execution, map.disparity_px);
  erase(left_out, kNaN, execution, map.disparity_y_px);
  erase(left_out, kNaN, execution, map.confidence);
  erase(left_out, kSet, execution, map.unmatched);
}

void erase_left_out(const Mask& left_out, Execution& execution, Image<float>& values) {
  erase(left_out, kNaN, execution, values);
}

void mark_left_out(const Mask& own, const Mask& other, Side side, float columns_per_px,
                   Execution& execution, MatchedMap& map) {
  if (own.empty() && other.empty()) {
    return;
  }
  const int width = map.unmatched.width();
  const int height = map.unmatched.height();
  const auto direction = static_cast<float>(direction_of(side));
  execution.for_each_row(height, [&](int y) {
    for (int x = 0; x < width; ++x) {
      if (!own.empty() && own.at(x, y) != 0) {
        map.unmatched.at(x, y) = kSet;
      }
      if (other.empty() || map.unmatched.at(x, y) != 0) {
        continue;
      }
      const float down = map.disparity_y_px.empty() ? 0 : map.disparity_y_px.at(x, y);
      const float column = std::round(static_cast<float>(x) +
                                      direction * columns_per_px * map.disparity_px.at(x, y));
      const float row = std::round(static_cast<float>(y) + direction * down);
      if (column >= 0 && column < static_cast<float>(width) && row >= 0 &&
          row < static_cast<float>(height) &&
          other.at(static_cast<int>(column), static_cast<int>(row)) != 0) {
        map.unmatched.at(x, y) = kSet;
      }
    }
  });
}

double share_of(const Mask& mask) {
  double set = 0;
  for (int y = 0; y < mask.height(); ++y) {
    set +=
        static_cast<double>(mask.width() - std::count(mask.row(y), mask.row(y) + mask.width(), 0));
  }
  return mask.empty() ? 0 : set / (static_cast<double>(mask.width()) * mask.height());
}

}  // namespace vantage
