#include "kernels/surface_splat/surface_splat.h"

#include <array>
#include <numeric>
#include <utility>

#include "kernels/forward_warp/forward_warp.h"
#include "tests/kernels/projection_cases.h"

namespace vantage::kernels::surface_splat_test {

constexpr float kNowhere = -std::numeric_limits<float>::infinity();

struct Map {
  std::vector<float> d;
  int width;
  int height;

  [[nodiscard]] float at(int x, int y) const { return d[y * width + x]; }
};

// A whole image into a view of this size, in bands and in segments of rows.
std::vector<float> warp(const Map& map, const ViewProjection& view, float limit, int view_width,
                        int view_height, int band_lines, int segment) {
  std::vector<float> nearness(view_width * view_height, kNowhere);
  for (int first_line = 0; first_line < view_height; first_line += band_lines) {
    const SplatBand band{.nearness = nearness.data() + first_line * view_width,
                         .stride = view_width,
                         .width = view_width,
                         .first_line = first_line,
                         .lines = std::min(band_lines, view_height - first_line)};
    for (int first = 0; first < map.width; first += segment) {
      const int count = std::min(segment, map.width - first);
      const auto project = [&](int y) {
        ProjectedValues row(count);
        if (y < map.height) {
          project_row(view,
                      {.disparity_px = map.d.data() + y * map.width + first,
                       .count = std::min(count + 1, map.width - first),
                       .first_column = first,
                       .line = y},
                      row.row());
        }
        return row;
      };
      for (int y = 0; y < map.height; ++y) {
        ProjectedValues upper = project(y);
        ProjectedValues lower = project(y + 1);
        splat_rows({.view = view,
                    .upper = upper.row(),
                    .lower = lower.row(),
                    .count = count,
                    .first_column = first,
                    .line = y,
                    .right_edge = right_edge_direction(view, map.width / 2, map.height / 2),
                    .lower_edge = lower_edge_direction(view, map.width / 2, map.height / 2),
                    .gradient_limit_px = limit},
                   band);
      }
    }
  }
  return nearness;
}

// The contract, word by word, in doubles: every sample into a z-buffer.
class PlainZBuffer {
 public:
  PlainZBuffer(const Map& map, const ViewProjection& view, float limit, int width, int height)
      : view_(view),
        width_(width),
        height_(height),
        nearest_(static_cast<std::size_t>(width * height), kNowhere),
        borderline_(nearest_.size()) {
    const EdgeDirection right = right_edge_direction(view, map.width / 2, map.height / 2);
    const EdgeDirection lower = lower_edge_direction(view, map.width / 2, map.height / 2);
    const auto corner = [&](int x, int y) {
      return x >= map.width || y >= map.height || std::isnan(map.at(x, y))
                 ? Corner{}
                 : target(x, y, map.at(x, y));
    };
    for (int y = 0; y < map.height; ++y) {
      for (int x = 0; x < map.width; ++x) {
        const std::array<Corner, 4> quad = {corner(x, y), corner(x + 1, y), corner(x, y + 1),
                                            corner(x + 1, y + 1)};
        const auto joined = [&](std::size_t i, std::size_t j) {
          return quad[i].known && quad[j].known && std::abs(quad[i].d - quad[j].d) <= limit;
        };
        if (quad[0].known) {
          add(quad[0].column(), quad[0].line(), quad[0].q);
        }
        if (!view.is_translation &&
            !(joined(0, 1) && joined(0, 2) && joined(1, 3) && joined(2, 3))) {
          add_quarters(x, y, quad, joined);
          continue;
        }
        if (joined(0, 1)) {
          add_edge(quad[0], quad[1], right);
        }
        if (joined(0, 2)) {
          add_edge(quad[0], quad[2], lower);
        }
        if (joined(0, 1) && joined(0, 2) && joined(1, 3) && joined(2, 3)) {
          const std::vector<Corner> corners(quad.begin(), quad.end());
          add_triangle({quad[0], quad[1], quad[2]}, corners);
          add_triangle({quad[1], quad[3], quad[2]}, corners);
          continue;
        }
        const std::size_t around[4] = {0, 1, 3, 2};
        for (std::size_t k = 0; k < 4; ++k) {
          const std::size_t before = around[(k + 3) % 4];
          const std::size_t centre = around[k];
          const std::size_t after = around[(k + 1) % 4];
          if (joined(before, centre) && joined(centre, after)) {
            add_triangle({quad[before], quad[centre], quad[after]},
                         {quad[before], quad[centre], quad[after], quad[centre]});
          }
        }
      }
    }
  }

  void expect_equal(const std::vector<float>& warped) const {
    for (std::size_t p = 0; p < nearest_.size(); ++p) {
      if (borderline_[p]) {
        continue;  // rounding decides whether a position belongs to a triangle
      }
      if (std::isinf(nearest_[p])) {
        ASSERT_EQ(warped[p], kNowhere) << "position " << p;
      } else {
        ASSERT_NEAR(warped[p], nearest_[p], 3e-5) << "position " << p;
      }
    }
  }

 private:
  struct Corner {
    double u = 0, v = 0, q = 0, d = 0;
    bool known = false;
    [[nodiscard]] double column() const { return std::floor(u + 0.5); }
    [[nodiscard]] double line() const { return std::floor(v + 0.5); }
  };

  [[nodiscard]] Corner target(double x, double y, double d) const {
    double p[3];
    for (int i = 0; i < 3; ++i) {
      p[i] = view_.homography[3 * i] * x + view_.homography[3 * i + 1] * y +
             view_.homography[3 * i + 2] + d * view_.parallax[i];
    }
    return p[2] <= 0 ? Corner{}
                     : Corner{p[0] / p[2], p[1] / p[2], (d - view_.infinity_disparity_px) / p[2], d,
                              true};
  }

  // A torn quad: each known corner has its quarter.
  template <typename Joined>
  void add_quarters(int left, int top, const std::array<Corner, 4>& quad, const Joined& joined) {
    for (std::size_t own = 0; own < 4; ++own) {
      if (!quad[own].known) {
        continue;
      }
      // All corners that neighbours join to this one.
      std::vector<std::size_t> surface = {own};
      for (std::size_t n = 0; n < surface.size(); ++n) {
        for (const std::size_t next : {surface[n] ^ 1U, surface[n] ^ 2U}) {
          if (joined(surface[n], next) &&
              std::find(surface.begin(), surface.end(), next) == surface.end()) {
            surface.push_back(next);
          }
        }
      }
      // Of three corners the one between the others does not count.
      std::vector<double> counting;
      for (const std::size_t k : surface) {
        if (surface.size() != 3 ||
            std::find(surface.begin(), surface.end(), k ^ 3U) != surface.end()) {
          counting.push_back(quad[k].d);
        }
      }
      const double middle = std::accumulate(counting.begin(), counting.end(), 0.0) /
                            static_cast<double>(counting.size());
      const auto half_way = [&](std::size_t k) {
        return joined(own, k) ? (quad[own].d + quad[k].d) / 2 : quad[own].d;
      };
      const double x = left + static_cast<double>(own & 1U);
      const double y = top + static_cast<double>(own >> 1U);
      const double centre_x = left + 0.5;
      const double centre_y = top + 0.5;
      const Corner beside = target(centre_x, y, half_way(own ^ 1U));
      const Corner across = target(x, centre_y, half_way(own ^ 2U));
      const Corner opposite = target(centre_x, centre_y, middle);
      if (!beside.known || !across.known || !opposite.known) {
        continue;
      }
      // Upper left, upper right, lower left, lower right.
      std::array<Corner, 4> quarter;
      quarter[own] = quad[own];
      quarter[own ^ 1U] = beside;
      quarter[own ^ 2U] = across;
      quarter[own ^ 3U] = opposite;
      add_all_inside({quarter[0], quarter[1], quarter[2]});
      add_all_inside({quarter[1], quarter[3], quarter[2]});
    }
  }

  void add(double column, double line, double q) {
    if (column >= 0 && column < width_ && line >= 0 && line < height_) {
      double& nearest = nearest_[static_cast<std::size_t>(line * width_ + column)];
      nearest = std::max(nearest, q);
    }
  }

  void add_edge(const Corner& a, const Corner& b, EdgeDirection direction) {
    const double from = direction.along_lines ? a.line() : a.column();
    const double to = direction.along_lines ? b.line() : b.column();
    for (double n = from + direction.sign; (to - n) * direction.sign > 0; n += direction.sign) {
      if (std::abs(n) > 1000) {
        continue;
      }
      const double f = direction.along_lines ? (n - a.v) / (b.v - a.v) : (n - a.u) / (b.u - a.u);
      const double other =
          std::floor((direction.along_lines ? a.u + f * (b.u - a.u) : a.v + f * (b.v - a.v)) + 0.5);
      add(direction.along_lines ? other : n, direction.along_lines ? n : other,
          (1 - f) * a.q + f * b.q);
    }
  }

  void add_triangle(const std::array<Corner, 3>& t, const std::vector<Corner>& left_out) {
    const double doubled_area =
        (t[1].u - t[0].u) * (t[2].v - t[0].v) - (t[2].u - t[0].u) * (t[1].v - t[0].v);
    const auto [left, right] = std::minmax({t[0].column(), t[1].column(), t[2].column()});
    const auto [top, bottom] = std::minmax({t[0].line(), t[1].line(), t[2].line()});
    if (doubled_area <= 0 || (right - left <= 1 && bottom - top <= 1)) {
      return;
    }
    add_inside(t, left_out, doubled_area);
  }

  void add_all_inside(const std::array<Corner, 3>& t) {
    const double doubled_area =
        (t[1].u - t[0].u) * (t[2].v - t[0].v) - (t[2].u - t[0].u) * (t[1].v - t[0].v);
    if (doubled_area > 0) {
      add_inside(t, {}, doubled_area);
    }
  }

  void add_inside(const std::array<Corner, 3>& t, const std::vector<Corner>& left_out,
                  double doubled_area) {
    const auto [left, right] = std::minmax({t[0].u, t[1].u, t[2].u});
    const auto [top, bottom] = std::minmax({t[0].v, t[1].v, t[2].v});
    for (double v = std::max(std::floor(top), 0.0); v <= std::min(bottom + 1, height_ - 1.0); ++v) {
      for (double u = std::max(std::floor(left), 0.0); u <= std::min(right + 1, width_ - 1.0);
           ++u) {
        // (u, v) = t0 + s (t1 − t0) + r (t2 − t0), by Cramer's rule.
        const double s =
            ((u - t[0].u) * (t[2].v - t[0].v) - (t[2].u - t[0].u) * (v - t[0].v)) / doubled_area;
        const double r =
            ((t[1].u - t[0].u) * (v - t[0].v) - (u - t[0].u) * (t[1].v - t[0].v)) / doubled_area;
        const double inside = std::min({s, r, 1 - s - r});
        bool is_corner = false;
        for (const Corner& corner : left_out) {
          is_corner = is_corner || (corner.column() == u && corner.line() == v);
        }
        if (std::abs(inside) < 1e-7) {
          borderline_[static_cast<std::size_t>(v * width_ + u)] = true;
        } else if (inside > 0 && !is_corner) {
          add(u, v, t[0].q + s * (t[1].q - t[0].q) + r * (t[2].q - t[0].q));
        }
      }
    }
  }

  ViewProjection view_;
  int width_;
  int height_;
  std::vector<double> nearest_;
  std::vector<bool> borderline_;
};

TEST(SurfaceSplat, IsTheZBufferOfAllSamples) {
  std::mt19937 random(1);
  constexpr int kSizes[][2] = {{1, 1}, {1, 7}, {7, 1}, {2, 2}, {3, 5}, {41, 27}, {67, 5}};
  for (const ViewProjection& view : projection_cases()) {
    for (const auto& [width, height] : kSizes) {
      for (const float limit : {0.0F, 0.55F, 1.05F}) {
        const Map map{random_map(random, width, height), width, height};
        const int view_width = width == 41 ? 37 : width;
        const int view_height = width == 41 ? 31 : height;
        const PlainZBuffer plain(map, view, limit, view_width, view_height);
        plain.expect_equal(warp(map, view, limit, view_width, view_height, view_height, width));
        ASSERT_FALSE(HasFatalFailure())
            << width << "x" << height << ", limit " << limit << ", parallax " << view.parallax[0]
            << ", " << view.parallax[1] << ", homography " << view.homography[0];
      }
    }
  }
}

// White noise: as many collisions and as few surfaces as can be.
TEST(SurfaceSplat, IsTheZBufferOfNoise) {
  std::mt19937 random(2);
  for (const ViewProjection& view : projection_cases()) {
    Map map{std::vector<float>(31 * 23), 31, 23};
    for (float& d : map.d) {
      const auto draw = random() % 81;
      d = draw == 0 ? kUnknownDisparity : static_cast<float>(draw) / 8 - 3;
    }
    PlainZBuffer(map, view, 1.05F, 31, 23).expect_equal(warp(map, view, 1.05F, 31, 23, 23, 31));
    ASSERT_FALSE(HasFatalFailure()) << "homography " << view.homography[0];
  }
}

TEST(SurfaceSplat, EqualsTheOrderedWalkAlongRows) {
  std::mt19937 random(3);
  for (const int width : kAwkwardWidths) {
    for (const double s : {-2.5, -1.0, -0.75, -0.3, 0.0, 0.1, 0.5, 1.0, 1.75, 4.0, 16.0}) {
      for (const float limit : {0.0F, 0.5F, 1.0F, 3.0F}) {
        const int height = 3;
        Map map{{}, width, height};
        for (int y = 0; y < height; ++y) {
          std::vector<float> row = random_disparities(random, width, -6, 30);
          for (float& d : row) {
            d += static_cast<float>(random() % 1000) / 7000;  // so that rounding has a say
          }
          map.d.insert(map.d.end(), row.begin(), row.end());
        }
        const std::vector<float> nearness =
            warp(map, translation(s, 0), limit, width, height, height, width);
        std::vector<float> expected(width);
        for (int y = 0; y < height; ++y) {
          forward_warp_row({map.d.data() + y * width, width, s, limit}, expected.data(), nullptr);
          for (int n = 0; n < width; ++n) {
            const float d = expected[n];
            ASSERT_EQ(nearness[y * width + n], std::isnan(d) ? kNowhere : d)
                << width << " wide, s " << s << ", limit " << limit << ", position " << n;
          }
        }
      }
    }
  }
}

TEST(SurfaceSplat, EqualInAnyCutOnEveryInstructionSet) {
  std::mt19937 random(4);
  for (const ViewProjection& view : projection_cases()) {
    for (const int width : {1, 15, 64, 65, 130}) {
      const int height = 9;
      Map map{random_map(random, width, height), width, height};
      map.d[random() % map.d.size()] = 3e38F;
      map.d[random() % map.d.size()] = -1e9F;
      const std::vector<float> expected = warp(map, view, 1.0F, width, 11, 11, width);
      for_each_target([&] {
        ASSERT_EQ(warp(map, view, 1.0F, width, 11, 11, width), expected);
        ASSERT_EQ(warp(map, view, 1.0F, width, 11, 4, width), expected);
        ASSERT_EQ(warp(map, view, 1.0F, width, 11, 1, 64), expected);
        ASSERT_EQ(warp(map, view, 1.0F, width, 11, 5, 13), expected);
      });
    }
  }
}

// A surface that is stretched has no cracks: inside its outline every position is covered.
TEST(SurfaceSplat, LeavesNoCracks) {
  const int size = 40;
  Map map{std::vector<float>(size * size), size, size};
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      map.d[y * size + x] = 5 + 0.4F * static_cast<float>(x) - 0.3F * static_cast<float>(y);
    }
  }
  for (const double roll : {0.0, 0.3, 0.785398163397448, 1.2, 1.5707963267948966, 3.0, -2.0}) {
    for (const double zoom : {0.5, 0.9, 1.0, 1.4142135623730951, 2.0, 2.3, 6.0}) {
      const ViewProjection view = camera(50, zoom, roll, 0.1, -0.1, {0.2, 0.1, 0}, 19.5, 19.5, 0);
      const std::vector<float> nearness = warp(map, view, 1.0F, size, size, size, size);
      // Around the middle of the view, which shows the surface in all of them.
      for (int v = 17; v < 23; ++v) {
        for (int u = 17; u < 23; ++u) {
          ASSERT_NE(nearness[v * size + u], kNowhere)
              << "roll " << roll << ", zoom " << zoom << " at " << u << ", " << v;
        }
      }
    }
  }
}

// Nor has an outline, where the homography alone spreads the pixels on its sides: it is in the
// middle between them. What parallax opens stays open.
TEST(SurfaceSplat, OnlyParallaxTears) {
  const int size = 40;
  Map map{std::vector<float>(size * size, 2.0F), size, size};
  for (int y = 12; y < 27; ++y) {
    std::fill_n(map.d.begin() + y * size + 14, 13, 9.0F);
  }
  for (const double roll : {0.0, 0.4, 1.5707963267948966, 2.5}) {
    for (const double zoom : {1.0, 1.7, 3.0}) {
      for (const double right : {0.0, 0.5}) {
        const ViewProjection view = camera(50, zoom, roll, 0, 0, {right, 0, 0}, 19.5, 19.5, 0);
        const std::vector<float> nearness = warp(map, view, 1.0F, size, size, size, size);
        int holes = 0;
        for (int v = 6; v < 34; ++v) {
          for (int u = 6; u < 34; ++u) {
            const float q = nearness[v * size + u];
            ASSERT_TRUE(q == 2 || q == 9 || q == kNowhere);
            holes += q == kNowhere ? 1 : 0;
            if (right == 0 && zoom == 3) {
              // Where the view's pixel lies in the image, from its middle.
              const double x = (std::cos(roll) * (u - 19.5) + std::sin(roll) * (v - 19.5)) / zoom;
              const double y = (std::cos(roll) * (v - 19.5) - std::sin(roll) * (u - 19.5)) / zoom;
              // Positions on the outline itself, and those that pixels are rounded to, aside.
              const double outside = std::max(std::max(13.5 - 19.5 - x, x - (26.5 - 19.5)),
                                              std::max(11.5 - 19.5 - y, y - (26.5 - 19.5)));
              if (std::abs(outside) > 0.25) {
                ASSERT_EQ(q, outside > 0 ? 2 : 9) << u << ", " << v << ", roll " << roll;
              }
            }
          }
        }
        // The outline is 15 pixels high and parallax moves it by 0.5 · 7 of the image's pixels.
        const double opened = right == 0 ? 0 : 15 * 3.5 * zoom * zoom;
        EXPECT_LE(holes, 1.2 * opened);
        EXPECT_GE(holes, zoom == 1 ? 0.8 * opened : 0);  // not all of it is looked at
      }
    }
  }
}

// Where a view is turned, targets of all neighbours are more than a column or line apart, but few
// positions between them are missing.
TEST(SurfaceSplat, FindsTheFewGapsOfTurnedSurfaces) {
  const int width = 137;
  const int height = 19;
  std::mt19937 random(5);
  Map slanted{{}, width, height};
  Map rough{{}, width, height};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      slanted.d.push_back(5 + 0.02F * static_cast<float>(x) - 0.03F * static_cast<float>(y));
      // Steps up to the limit of one surface, and beyond it.
      rough.d.push_back(slanted.d.back() + 0.45F * static_cast<float>(random() % 4));
    }
  }
  for (const double roll : {0.2, 0.5, 0.785398163397448, 1.1, 2.0, -0.5, -2.5}) {
    for (const double zoom : {0.8, 1.0, 1.1}) {
      for (const double right : {0.2, 1.3}) {
        const ViewProjection view = camera(150, zoom, roll, 0.02, -0.03, {right, 0.1, 0}, 68, 9, 0);
        for (const Map* map : {&slanted, &rough}) {
          const std::vector<float> expected = warp(*map, view, 1.0F, width, 50, 50, width);
          for_each_target([&] {
            ASSERT_EQ(warp(*map, view, 1.0F, width, 50, 50, width), expected)
                << "roll " << roll << ", zoom " << zoom << ", right " << right;
          });
        }
      }
    }
  }
}

TEST(SurfaceSplat, WalksEdgesAlongTheirAxis) {
  const auto right = [](double roll) {
    return right_edge_direction(camera(50, 1, roll, 0, 0, {0, 0, 0}, 10, 10, 0), 10, 10);
  };
  const auto lower = [](double roll) {
    return lower_edge_direction(camera(50, 1, roll, 0, 0, {0, 0, 0}, 10, 10, 0), 10, 10);
  };
  EXPECT_FALSE(right(0.1).along_lines);
  EXPECT_EQ(right(0.1).sign, 1);
  EXPECT_TRUE(lower(0.1).along_lines);
  EXPECT_EQ(lower(0.1).sign, 1);
  EXPECT_TRUE(right(1.5).along_lines);
  EXPECT_EQ(right(1.5).sign, 1);
  EXPECT_FALSE(lower(1.5).along_lines);
  EXPECT_EQ(lower(1.5).sign, -1);
  EXPECT_EQ(right(3.1).sign, -1);
  EXPECT_EQ(lower(3.1).sign, -1);
  EXPECT_EQ(right(-1.5).sign, -1);
  EXPECT_EQ(lower(-1.5).sign, 1);
}

}  // namespace vantage::kernels::surface_splat_test
