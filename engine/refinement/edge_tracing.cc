#include "engine/refinement/edge_tracing.h"

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <vector>

namespace vantage {
namespace {

constexpr std::uint8_t kEdge = 255;
constexpr std::uint8_t kCandidate = 128;

/// kCandidate where the squared length of a gradient is above `limit`, else 0.
void mark_longer(const std::int16_t* gradient_x, const std::int16_t* gradient_y, int limit,
                 int width, std::uint8_t* marks) {
  for (int x = 0; x < width; ++x) {
    const int length = gradient_x[x] * gradient_x[x] + gradient_y[x] * gradient_y[x];
    marks[x] = length > limit ? kCandidate : 0;
  }
}

/// Calls body(x) where row[x] is `value` when x is reached.
template <typename Body>
void for_each_equal(const std::uint8_t* row, int width, std::uint8_t value, const Body& body) {
  for (int x = 0; x < width; ++x) {
    const void* const found = std::memchr(row + x, value, static_cast<std::size_t>(width - x));
    if (found == nullptr) {
      return;
    }
    x = static_cast<int>(static_cast<const std::uint8_t*>(found) - row);
    body(x);
  }
}

/// Squared lengths of gradients.
class Lengths {
 public:
  Lengths(const Image<std::int16_t>& gradient_x, const Image<std::int16_t>& gradient_y)
      : x_(gradient_x), y_(gradient_y) {}

  [[nodiscard]] int inside(int x, int y) const {
    const int gx = x_.at(x, y);
    const int gy = y_.at(x, y);
    return gx * gx + gy * gy;
  }

  /// Whether a pixel has the longest gradient of the three along its direction.
  [[nodiscard]] bool is_longest(int x, int y) const {
    const int gx = x_.at(x, y);
    const int gy = y_.at(x, y);
    const int length = inside(x, y);
    // Multiples of 2⁻¹⁵, which bound the four directions: the tangents of 22.5 and 67.5 degrees.
    const std::int64_t tangent = std::int64_t{std::abs(gy)} << 15U;
    const std::int64_t low = std::int64_t{std::abs(gx)} * 13573;
    const std::int64_t high = low + (std::int64_t{std::abs(gx)} << 16U);
    if (tangent < low) {
      return length > at(x - 1, y) && length >= at(x + 1, y);
    }
    if (tangent > high) {
      return length > at(x, y - 1) && length >= at(x, y + 1);
    }
    const int side = (gx < 0) != (gy < 0) ? -1 : 1;
    return length > at(x - side, y - 1) && length > at(x + side, y + 1);
  }

 private:
  [[nodiscard]] int at(int x, int y) const {
    return x < 0 || x >= x_.width() || y < 0 || y >= x_.height() ? 0 : inside(x, y);
  }

  const Image<std::int16_t>& x_;
  const Image<std::int16_t>& y_;
};

/// Makes edges of the candidates that are connected to edges.
class Connection {
 public:
  explicit Connection(Mask& edges) : edges_(edges) {}

  void follow_all() {
    for (int y = 0; y < edges_.height(); ++y) {
      for_each_equal(edges_.row(y), edges_.width(), kEdge, [&](int x) { follow({x, y}); });
    }
  }

 private:
  struct Place {
    int x;
    int y;
  };

  void follow(Place edge) {
    open_.push_back(edge);
    while (!open_.empty()) {
      const Place from = open_.back();
      open_.pop_back();
      for (int y = std::max(from.y - 1, 0); y <= std::min(from.y + 1, edges_.height() - 1); ++y) {
        for (int x = std::max(from.x - 1, 0); x <= std::min(from.x + 1, edges_.width() - 1); ++x) {
          if (edges_.at(x, y) == kCandidate) {
            edges_.at(x, y) = kEdge;
            open_.push_back({x, y});
          }
        }
      }
    }
  }

  Mask& edges_;
  std::vector<Place> open_;
};

}  // namespace

void trace_edges(const Image<std::int16_t>& gradient_x, const Image<std::int16_t>& gradient_y,
                 EdgeThresholds thresholds, Execution& execution, Mask& edges) {
  const Lengths lengths(gradient_x, gradient_y);
  const int low = thresholds.low * thresholds.low;
  const int high = thresholds.high * thresholds.high;
  execution.for_each_row(edges.height(), [&](int y) {
    std::uint8_t* const row = edges.row(y);
    mark_longer(gradient_x.row(y), gradient_y.row(y), low, edges.width(), row);
    for_each_equal(row, edges.width(), kCandidate, [&](int x) {
      if (!lengths.is_longest(x, y)) {
        row[x] = 0;
      } else if (lengths.inside(x, y) > high) {
        row[x] = kEdge;
      }
    });
  });
  Connection(edges).follow_all();
  execution.for_each_row(edges.height(), [&](int y) {
    std::uint8_t* const row = edges.row(y);
    for (int x = 0; x < edges.width(); ++x) {
      row[x] = row[x] == kEdge ? kEdge : 0;
    }
  });
}

}  // namespace vantage
