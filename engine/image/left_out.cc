#include "engine/image/left_out.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <limits>
#include <utility>
#include <variant>
#include <vector>

#include "engine/error.h"

namespace vantage {
namespace {

constexpr std::uint8_t kSet = 255;

template <typename T>
void set_where(const Mask& mask, T value, Image<T>& image) {
  if (mask.empty() || mask.width() != image.width() || mask.height() != image.height()) {
    return;
  }
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      if (mask.at(x, y) != 0) {
        std::fill_n(image.row(y) + x * image.channels(), image.channels(), value);
      }
    }
  }
}

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

}  // namespace

void leave_out(Photograph& photograph, Mask left_out) {
  if (share_of(left_out) == 0) {
    return;
  }
  if (!photograph.left_out.empty()) {
    for (int y = 0; y < left_out.height(); ++y) {
      std::transform(left_out.row(y), left_out.row(y) + left_out.width(),
                     photograph.left_out.row(y), left_out.row(y), std::bit_or<std::uint8_t>());
    }
  }
  photograph.left_out = std::move(left_out);
  std::visit([&](auto& image) { fill_image(photograph.left_out, image); }, photograph.pixels);
}

void leave_out_no_data(Photograph& photograph, std::optional<double> no_data) {
  Mask without_data = std::visit(
      [&]<typename T>(const Image<T>& image) {
        const int channels = image.channels();
        const auto is_no_data = [&](T value) { return no_data && value == *no_data; };
        const auto is_nan = [](T value) { return value != value; };
        Mask mask(image.width(), image.height());
        for (int y = 0; y < image.height(); ++y) {
          for (int x = 0; x < image.width(); ++x) {
            const T* pixel = image.row(y) + x * channels;
            mask.at(x, y) = std::any_of(pixel, pixel + channels, is_nan) ||
                                    std::all_of(pixel, pixel + channels, is_no_data)
                                ? kSet
                                : 0;
          }
        }
        return mask;
      },
      photograph.pixels);
  const double share = share_of(without_data);
  if (share == 1) {
    throw Error("no pixel has data, expected numbers");
  }
  if (share > 0) {
    leave_out(photograph, std::move(without_data));
    photograph.origin.remarks.push_back(
        {Remark::Kind::kNote, "no data",
         fmt::format("pixels without data ({}) are left out",
                     no_data ? fmt::format("{:g}, as the file says", *no_data) : "NaN")});
  }
}

void blacken_left_out(Photograph& photograph) {
  std::visit([&]<typename T>(Image<T>& image) { set_where(photograph.left_out, T{0}, image); },
             photograph.pixels);
}

Mask half_of(const Mask& left_out) {
  if (left_out.empty()) {
    return {};
  }
  Mask half((left_out.width() + 1) / 2, (left_out.height() + 1) / 2);
  for (int y = 0; y < half.height(); ++y) {
    const std::uint8_t* const upper = left_out.row(2 * y);
    const std::uint8_t* const lower = left_out.row(std::min(2 * y + 1, left_out.height() - 1));
    for (int x = 0; x < half.width(); ++x) {
      const int right = std::min(2 * x + 1, left_out.width() - 1);
      half.at(x, y) = std::min({upper[2 * x], upper[right], lower[2 * x], lower[right]});
    }
  }
  return half;
}

void erase_left_out(const Mask& left_out, Image<float>& values) {
  set_where(left_out, std::numeric_limits<float>::quiet_NaN(), values);
}

void erase_left_out(const Mask& left_out, MatchedMap& map) {
  erase_left_out(left_out, map.disparity_px);
  erase_left_out(left_out, map.disparity_y_px);
  set_where(left_out, 0.0F, map.confidence);
  set_where(left_out, kSet, map.unmatched);
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
  const double pixels = static_cast<double>(mask.width()) * mask.height();
  std::ptrdiff_t set = 0;
  for (int y = 0; y < mask.height(); ++y) {
    set += mask.width() - std::count(mask.row(y), mask.row(y) + mask.width(), 0);
  }
  return mask.empty() ? 0 : static_cast<double>(set) / pixels;
}

}  // namespace vantage
