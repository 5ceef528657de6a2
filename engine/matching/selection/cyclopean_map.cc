#include "engine/matching/selection/cyclopean_map.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace vantage {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
/// Larger differences of neighbours are edges of surfaces.
constexpr double kMaxSlope = 1.5;
/// Where the disparities of a slanted surface grow by one, one column has no match.
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

  /// `left`, `right`: disparities of the matches by column of either image.
  void mark_unseen(const std::vector<float>& left, const std::vector<float>& right) {
    int end = 0;
    for (int begin = 0; begin < width_; begin = end) {
      const bool is_seen = !std::isnan(disparity_px_[begin]);
      for (end = begin + 1; end < width_ && std::isnan(disparity_px_[end]) != is_seen; ++end) {
      }
      const float behind = is_seen ? kNaN : background(begin, end);
      for (int x = begin; x < end; ++x) {
        seen_by_[x] = static_cast<std::uint8_t>(
            is_seen              ? SeenBy::kBoth
            : std::isnan(behind) ? SeenBy::kNone
                                 : seen_by(x, static_cast<double>(behind), left, right));
      }
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
  /// Disparity of the farther surface beside pixels without a match; NaN if there is none.
  [[nodiscard]] float background(int begin, int end) const {
    const float before = begin > 0 ? disparity_px_[begin - 1] : kNaN;
    const float after = end < width_ ? disparity_px_[end] : kNaN;
    return std::fmin(before, after);
  }
  /// Who sees a point of the background: a camera does not where something nearer has a match, or
  /// outside its image.
  [[nodiscard]] SeenBy seen_by(int x, double behind_px, const std::vector<float>& left,
                               const std::vector<float>& right) const {
    const auto is_hidden = [&](double column, const std::vector<float>& matches) {
      const double nearest = std::floor(column + 0.5);
      return !(nearest >= 0 && nearest < width_) ||
             static_cast<double>(matches[static_cast<std::size_t>(nearest)]) >
                 behind_px + kMaxSlope;
    };
    const bool from_left = is_hidden(x + behind_px / 2, left);
    const bool from_right = is_hidden(x - behind_px / 2, right);
    return from_left == from_right ? SeenBy::kNone : from_left ? SeenBy::kRight : SeenBy::kLeft;
  }

  float* disparity_px_;
  std::uint8_t* seen_by_;
  int width_;
};

void make_row(const MatchedMap& left, int y, Row& row) {
  const float* const disparity_px = left.disparity_px.row(y);
  const std::uint8_t* const unmatched = left.unmatched.row(y);
  const int width = left.disparity_px.width();
  std::vector<float> of_left(static_cast<std::size_t>(width), kNaN);
  std::vector<float> of_right(static_cast<std::size_t>(width), kNaN);
  Match last;
  bool has_last = false;
  for (int x = 0; x < width; ++x) {
    if (unmatched[x] != 0 || !std::isfinite(disparity_px[x])) {
      continue;
    }
    const auto at = static_cast<double>(disparity_px[x]);
    of_left[static_cast<std::size_t>(x)] = disparity_px[x];
    if (const double partner = std::floor(x - at + 0.5); partner >= 0 && partner < width) {
      float& nearest = of_right[static_cast<std::size_t>(partner)];
      nearest = std::fmax(nearest, disparity_px[x]);
    }
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
  row.mark_unseen(of_left, of_right);
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
