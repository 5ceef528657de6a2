#include "engine/image/black_border.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <variant>
#include <vector>

#include "engine/image/intensity_rows.h"

namespace vantage {
namespace {

using Levels = Image<std::uint8_t>;

// In grey levels. Codecs and converters leave some noise in bars.
constexpr int kBarLevel = 12;
constexpr int kWedgeLevel = 1;
constexpr int kBrightLevel = 24;

constexpr double kMaxBarShare = 0.4;     // of the picture, on one side
constexpr double kStraightShare = 0.97;  // of a bar's edge within kEdgePx of its place
constexpr int kEdgePx = 2;
constexpr double kBrightShare = 0.5;  // of the edge that is bright within kSoftPx beyond it
constexpr int kSoftPx = 4;

constexpr int kMinWedgePx = 3;      // its largest width
constexpr int kMinWedgeLines = 24;  // lines from its first to its last
constexpr int kBendLines = 6;       // between the lines that a bend is measured on
constexpr double kMaxBendPx = 1.5;
constexpr double kEvenShare = 0.95;  // of its lines that bend no more

/// A picture seen from one of its borders: lines go inwards from there.
struct Border {
  const Levels& levels;
  bool is_column;  ///< lines are columns: the upper or lower border
  bool is_far;     ///< the right or lower border

  [[nodiscard]] int lines() const { return is_column ? levels.width() : levels.height(); }
  [[nodiscard]] int depth() const { return is_column ? levels.height() : levels.width(); }
  [[nodiscard]] std::array<int, 2> place(int line, int at) const {
    const int inwards = is_far ? depth() - 1 - at : at;
    return is_column ? std::array{line, inwards} : std::array{inwards, line};
  }
  [[nodiscard]] int level(int line, int at) const {
    const auto [x, y] = place(line, at);
    return levels.at(x, y);
  }
  /// Pixels from the border inwards that are at most so bright, of each line.
  [[nodiscard]] std::vector<int> black_px(int max_level) const {
    std::vector<int> lengths(static_cast<std::size_t>(lines()));
    for (int line = 0; line < lines(); ++line) {
      int& length = lengths[static_cast<std::size_t>(line)];
      while (length < depth() && level(line, length) <= max_level) {
        ++length;
      }
    }
    return lengths;
  }
  /// Whether something is bright just beyond the black pixels of a line.
  [[nodiscard]] bool is_bright_beyond(int line, int length) const {
    for (int at = length; at < std::min(depth(), length + kSoftPx); ++at) {
      if (level(line, at) >= kBrightLevel) {
        return true;
      }
    }
    return false;
  }
};

/// Width of the bar along a border; 0: there is none.
int bar_px(const Border& border) {
  const std::vector<int> lengths = border.black_px(kBarLevel);
  std::vector<int> sorted = lengths;
  std::ranges::nth_element(sorted, sorted.begin() + border.lines() / 2);
  const int width = sorted[sorted.size() / 2];
  if (width < 2 || width > kMaxBarShare * border.depth()) {
    return 0;
  }
  int at_edge = 0;
  int bright = 0;
  for (int line = 0; line < border.lines(); ++line) {
    const int length = lengths[static_cast<std::size_t>(line)];
    // Bars of other sides have none.
    at_edge += std::abs(length - width) <= kEdgePx || length == border.depth() ? 1 : 0;
    bright += border.is_bright_beyond(line, width) ? 1 : 0;
  }
  const bool is_bar =
      at_edge >= kStraightShare * border.lines() && bright >= kBrightShare * border.lines();
  return is_bar ? width : 0;
}

/// Whether the lines of a run of black ones, which ends before `end`, are a wedge.
bool is_wedge(const Border& border, const std::vector<int>& lengths, int first, int end) {
  const auto length = [&](int line) { return lengths[static_cast<std::size_t>(line)]; };
  int widest = 0;
  int even = 0;
  int measured = 0;
  int bright = 0;
  for (int line = first; line < end; ++line) {
    widest = std::max(widest, length(line));
    bright += border.is_bright_beyond(line, length(line)) ? 1 : 0;
    if (line >= first + kBendLines && line < end - kBendLines) {
      ++measured;
      const int ends = length(line - kBendLines) + length(line + kBendLines);
      even += std::abs(ends / 2.0 - length(line)) <= kMaxBendPx ? 1 : 0;
    }
  }
  return widest >= kMinWedgePx && widest <= kMaxBarShare * border.depth() &&
         end - first >= kMinWedgeLines && even >= kEvenShare * measured &&
         bright >= kBrightShare * (end - first);
}

void mark(const Border& border, int line, int length, Mask& mask) {
  if (mask.empty()) {
    mask.resize(border.levels.width(), border.levels.height());
    mask.fill(0);
  }
  for (int at = 0; at < length; ++at) {
    const auto [x, y] = border.place(line, at);
    mask.at(x, y) = 255;
  }
}

void mark_wedges(const Border& border, Mask& mask) {
  const std::vector<int> lengths = border.black_px(kWedgeLevel);
  for (int first = 0; first < border.lines(); ++first) {
    int end = first;
    while (end < border.lines() && lengths[static_cast<std::size_t>(end)] > 0 &&
           lengths[static_cast<std::size_t>(end)] < border.depth()) {
      ++end;
    }
    if (end - first >= kMinWedgeLines && is_wedge(border, lengths, first, end)) {
      for (int line = first; line < end; ++line) {
        mark(border, line, lengths[static_cast<std::size_t>(line)], mask);
      }
    }
    first = end;
  }
}

}  // namespace

void BrightestLevels::add(const Photograph& photograph) {
  const bool is_first =
      levels_.width() != photograph.width() || levels_.height() != photograph.height();
  if (is_first) {
    levels_.resize(photograph.width(), photograph.height());
    levels_.fill(0);
  }
  std::vector<float> grey(static_cast<std::size_t>(photograph.width()));
  for (int y = 0; y < photograph.height(); ++y) {
    intensity_row(photograph, y, grey.data());
    std::uint8_t* const row = levels_.row(y);
    for (int x = 0; x < photograph.width(); ++x) {
      row[x] = std::max(row[x], static_cast<std::uint8_t>(std::clamp(
                                    std::ceil(grey[static_cast<std::size_t>(x)]), 0.0F, 255.0F)));
    }
  }
}

bool may_have_black_border(const Photograph& photograph) {
  const auto is_black = [&](int x, int y) {
    return std::visit(
        [&]<typename T>(const Image<T>& image) {
          const T* const pixel = image.row(y) + x * image.channels();
          return std::all_of(pixel, pixel + std::min(3, image.channels()), [](T value) {
            return kGreyLevelsPerUnit<T> * static_cast<float>(value) <= kBarLevel;
          });
        },
        photograph.pixels);
  };
  const auto is_mostly_black = [](int pixels, const auto& is_black_at) {
    int black = 0;
    for (int i = 0; i < pixels; ++i) {
      black += is_black_at(i) ? 1 : 0;
    }
    return black >= std::min(kMinWedgeLines, pixels);
  };
  const int width = photograph.width();
  const int height = photograph.height();
  return is_mostly_black(width, [&](int x) { return is_black(x, 0); }) ||
         is_mostly_black(width, [&](int x) { return is_black(x, height - 1); }) ||
         is_mostly_black(height, [&](int y) { return is_black(0, y); }) ||
         is_mostly_black(height, [&](int y) { return is_black(width - 1, y); });
}

std::array<Mask, 2> black_borders(const Levels& left, const Levels& right) {
  std::array<Mask, 2> masks;
  for (const bool is_column : {false, true}) {
    for (const bool is_far : {false, true}) {
      const std::array<Border, 2> borders = {Border{left, is_column, is_far},
                                             Border{right, is_column, is_far}};
      const std::array<int, 2> widths = {bar_px(borders[0]), bar_px(borders[1])};
      const bool are_bars = !is_column || std::abs(widths[0] - widths[1]) <= kEdgePx;
      for (const std::size_t i : {0, 1}) {
        if (are_bars && widths[i] > 0) {
          for (int line = 0; line < borders[i].lines(); ++line) {
            mark(borders[i], line, widths[i], masks[i]);
          }
        } else {
          mark_wedges(borders[i], masks[i]);
        }
      }
    }
  }
  return masks;
}

std::array<Mask, 2> black_borders(const Photograph& left, const Photograph& right) {
  if (!may_have_black_border(left) && !may_have_black_border(right)) {
    return {};
  }
  std::array<BrightestLevels, 2> levels;
  levels[0].add(left);
  levels[1].add(right);
  return black_borders(levels[0].levels(), levels[1].levels());
}

}  // namespace vantage
