#include "engine/matching/selection/cyclopean_map.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vantage {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
/// Larger differences of neighbours are edges of surfaces.
constexpr double kMaxSlope = 1.5;
/// Of a slanted surface, the solution leaves out one column where disparities grow by one.
constexpr int kMaxColumnsApart = 2;

/// A match as the middle camera sees it.
struct Match {
  int left_column = 0;
  double column = 0;
  double disparity_px = 0;
};

/// One row of the map.
class Row {
 public:
  Row(float* disparity_px, std::uint8_t* seen_by, int width)
      : disparity_px_(disparity_px), seen_by_(seen_by), width_(width) {
    std::fill_n(disparity_px_, width_, kNaN);
  }

  /// The pixels from the first match to the second, of one surface.
  void connect(const Match& first, const Match& second) {
    const double span = second.column - first.column;
    each_pixel(first.column, second.column, [&](int x) {
      const double share = span > 0 ? (x - first.column) / span : 0;
      offer(x, first.disparity_px + share * (second.disparity_px - first.disparity_px));
    });
  }
  /// Half a pixel beyond an end of a surface.
  void extend_before(const Match& match) {
    each_pixel(match.column - 0.5, match.column, [&](int x) { offer(x, match.disparity_px); });
  }
  void extend_after(const Match& match) {
    // Half of the way is the pixel of what follows.
    each_pixel(match.column, std::nextafter(match.column + 0.5, match.column),
               [&](int x) { offer(x, match.disparity_px); });
  }

  void mark_unseen() {
    int end = 0;
    for (int begin = 0; begin < width_; begin = end) {
      const bool is_seen = !std::isnan(disparity_px_[begin]);
      for (end = begin + 1; end < width_ && std::isnan(disparity_px_[end]) != is_seen; ++end) {
      }
      std::fill(seen_by_ + begin, seen_by_ + end,
                static_cast<std::uint8_t>(is_seen ? SeenBy::kBoth : hidden_from(begin, end)));
    }
  }

 private:
  template <typename Visit>
  void each_pixel(double first, double last, const Visit& visit) const {
    const int end = static_cast<int>(std::floor(std::min<double>(last, width_ - 1))) + 1;
    for (int x = static_cast<int>(std::ceil(std::max(first, 0.0))); x < end; ++x) {
      visit(x);
    }
  }
  void offer(int x, double disparity_px) {
    const auto offered = static_cast<float>(disparity_px);
    if (!(disparity_px_[x] >= offered)) {
      disparity_px_[x] = offered;
    }
  }
  /// Who sees the pixels between two surfaces, or between one and the border.
  [[nodiscard]] SeenBy hidden_from(int begin, int end) const {
    if (begin == 0 && end == width_) {
      return SeenBy::kNone;
    }
    // Beyond the left border of the right image for disparities above 0.
    const float before = begin > 0 ? disparity_px_[begin - 1] : -disparity_px_[end];
    const float after = end < width_ ? disparity_px_[end] : -disparity_px_[begin - 1];
    const bool is_edge =
        begin == 0 || end == width_ ? before != after : std::abs(after - before) > kMaxSlope;
    return !is_edge ? SeenBy::kNone : after > before ? SeenBy::kLeft : SeenBy::kRight;
  }

  float* disparity_px_;
  std::uint8_t* seen_by_;
  int width_;
};

void make_row(const MatchedMap& left, int y, Row& row) {
  const float* const disparity_px = left.disparity_px.row(y);
  const std::uint8_t* const unmatched = left.unmatched.row(y);
  Match last;
  bool has_last = false;
  for (int x = 0; x < left.disparity_px.width(); ++x) {
    if (unmatched[x] != 0 || !std::isfinite(disparity_px[x])) {
      continue;
    }
    const auto at = static_cast<double>(disparity_px[x]);
    const Match match{x, x - at / 2, at};
    const bool is_one_surface = has_last && x <= last.left_column + kMaxColumnsApart &&
                                std::abs(at - last.disparity_px) <= kMaxSlope;
    if (is_one_surface) {
      row.connect(last, match);
    } else {
      if (has_last) {
        row.extend_after(last);
      }
      row.extend_before(match);
    }
    last = match;
    has_last = true;
  }
  if (has_last) {
    row.extend_after(last);
  }
  row.mark_unseen();
}

}  // namespace

void make_cyclopean_map(const MatchedMap& left, Execution& execution, CyclopeanMap& map) {
  const int width = left.disparity_px.width();
  const int height = left.disparity_px.height();
  map.disparity_px.resize(width, height);
  map.seen_by.resize(width, height);
  execution.for_each_band(height, [&](int first_row, int end_row) {
    for (int y = first_row; y < end_row; ++y) {
      Row row(map.disparity_px.row(y), map.seen_by.row(y), width);
      make_row(left, y, row);
    }
  });
}

}  // namespace vantage
