#include "kernels/surface_splat/quad_gaps.h"

#include <algorithm>
#include <cmath>

namespace vantage::kernels {
namespace {

// Positions outside a triangle by at most this fraction of its area count as on its border.
constexpr double kOnBorder = 1e-9;

using Corner = QuadCorner;

QuadCorner corner_of(const SplatRows& rows, const ProjectedRow& row, int i, int line) {
  const ExactTarget target =
      exact_target(rows.view, rows.first_column + i, line, row.disparity_px[i]);
  return {.u = target.u,
          .v = target.v,
          .nearness = row.nearness[i],
          .disparity_px = row.disparity_px[i],
          .column = row.column[i],
          .line = row.line[i]};
}

void add_sample(const SplatBand& band, int column, int line, double nearness) {
  float& nearest = band.nearness[(line - band.first_line) * band.stride + column];
  nearest = std::max(nearest, static_cast<float>(nearness));
}

// Fills the positions between the targets of two neighbours along the axis of their edge.
void fill_edge(const Corner& from, const Corner& to, EdgeDirection direction,
               const SplatBand& band) {
  const bool along_lines = direction.along_lines;
  const int begin = along_lines ? from.line : from.column;
  const int end = along_lines ? to.line : to.column;
  const double first = along_lines ? from.v : from.u;
  const double spacing = (along_lines ? to.v : to.u) - first;
  const double other = along_lines ? from.u : from.v;
  const double rise_of_other = (along_lines ? to.u : to.v) - other;
  const double rise = double{to.nearness} - double{from.nearness};
  const int min = along_lines ? band.first_line : 0;
  const int max = along_lines ? band.first_line + band.lines - 1 : band.width - 1;
  const int last = std::min(std::max(begin, end) - 1, max);
  for (int n = std::max(std::min(begin, end) + 1, min); n <= last; ++n) {
    const double fraction = (n - first) / spacing;
    const double exact = other + fraction * rise_of_other;
    const double rounded = std::floor(exact + 0.5);
    const double limit = along_lines ? band.width : band.first_line + band.lines;
    if (rounded >= (along_lines ? 0 : band.first_line) && rounded < limit) {
      const int whole = static_cast<int>(rounded);
      add_sample(band, along_lines ? whole : n, along_lines ? n : whole,
                 from.nearness + fraction * rise);
    }
  }
}

bool is_gap(const Corner& first, const Corner& second, EdgeDirection direction) {
  const int distance =
      direction.along_lines ? second.line - first.line : second.column - first.column;
  return distance * direction.sign > 1;
}

/// Twice the area of the triangle of two corners and a position, as a linear function of the
/// position. Positive on the side of a third corner that makes the triangle turn like (right,
/// down).
struct Border {
  double u;
  double v;
  double rise_u;
  double rise_v;

  Border(const Corner& from, const Corner& to)
      : u(from.u), v(from.v), rise_u(from.v - to.v), rise_v(to.u - from.u) {}
  [[nodiscard]] double at(double position_u, double position_v) const {
    return rise_u * (position_u - u) + rise_v * (position_v - v);
  }
};

// Adds the triangle's sample at (u, v) if that is inside.
void add_inside(const Corner& a, const Corner& b, const Corner& c, int u, int v,
                const SplatBand& band) {
  // The border opposite to each corner.
  const Border of_a(b, c);
  const Border of_b(c, a);
  const Border of_c(a, b);
  const double area = of_a.at(a.u, a.v);
  if (!(area > 0)) {
    return;
  }
  const double weight_a = of_a.at(u, v);
  const double weight_b = of_b.at(u, v);
  const double weight_c = of_c.at(u, v);
  const double on_border = -kOnBorder * area;
  if (weight_a >= on_border && weight_b >= on_border && weight_c >= on_border) {
    add_sample(band, u, v,
               (weight_a * a.nearness + weight_b * b.nearness + weight_c * c.nearness) /
                   (weight_a + weight_b + weight_c));
  }
}

// fourth: one more corner whose target is left out, or null.
void fill_triangle(const Corner& a, const Corner& b, const Corner& c, const Corner* fourth,
                   const SplatBand& band) {
  const int min_column = std::min({a.column, b.column, c.column});
  const int max_column = std::max({a.column, b.column, c.column});
  const int min_line = std::min({a.line, b.line, c.line});
  const int max_line = std::max({a.line, b.line, c.line});
  if (max_column - min_column <= 1 && max_line - min_line <= 1) {
    return;
  }
  const int first_line = std::max(
      std::min({first_whole(a.v, a.line), first_whole(b.v, b.line), first_whole(c.v, c.line)}),
      band.first_line);
  const int last_line = std::min(
      std::max({last_whole(a.v, a.line), last_whole(b.v, b.line), last_whole(c.v, c.line)}),
      band.first_line + band.lines - 1);
  const int first_column =
      std::max(std::min({first_whole(a.u, a.column), first_whole(b.u, b.column),
                         first_whole(c.u, c.column)}),
               0);
  const int last_column = std::min(
      std::max({last_whole(a.u, a.column), last_whole(b.u, b.column), last_whole(c.u, c.column)}),
      band.width - 1);
  for (int v = first_line; v <= last_line; ++v) {
    for (int u = first_column; u <= last_column; ++u) {
      const auto lands_here = [&](const Corner& corner) {
        return corner.column == u && corner.line == v;
      };
      if (!(lands_here(a) || lands_here(b) || lands_here(c) ||
            (fourth != nullptr && lands_here(*fourth)))) {
        add_inside(a, b, c, u, v, band);
      }
    }
  }
}

// Integers in [least, most] within the limits. Does not use the library's rounding functions, which
// are calls on the processors that this is compiled for.
struct WholeRange {
  int first;
  int last;

  WholeRange(double min, double max, int min_limit, int max_limit) {
    const double from = std::clamp(min - kOutsidePx, min_limit - 1.0, max_limit + 1.0);
    const double to = std::clamp(max + kOutsidePx, min_limit - 1.0, max_limit + 1.0);
    const int whole_from = static_cast<int>(from);
    const int whole_to = static_cast<int>(to);
    first = std::max(whole_from + (whole_from < from ? 1 : 0), min_limit);
    last = std::min(whole_to - (whole_to > to ? 1 : 0), max_limit);
  }
};

// Adds the samples of a part of a quad at every position inside its two triangles.
void fill_part(const Corner (&part)[4], const SplatBand& band) {
  const auto& [a, b, c, d] = part;
  const WholeRange columns(std::min({a.u, b.u, c.u, d.u}), std::max({a.u, b.u, c.u, d.u}), 0,
                           band.width - 1);
  const WholeRange lines(std::min({a.v, b.v, c.v, d.v}), std::max({a.v, b.v, c.v, d.v}),
                         band.first_line, band.first_line + band.lines - 1);
  for (int v = lines.first; v <= lines.last; ++v) {
    for (int u = columns.first; u <= columns.last; ++u) {
      add_inside(a, b, c, u, v, band);
      add_inside(b, d, c, u, v, band);
    }
  }
}

// Disparity of a surface in the middle of a quad: the mean over the quad's corners on the surface;
// with three, over the two that are not adjacent. `is_on`: by corner.
double middle_disparity(const bool (&is_on)[4], const float (&disparity_px)[4]) {
  const auto count = std::count(is_on, is_on + 4, true);
  if (count == 3) {
    const auto missing = static_cast<unsigned>(std::find(is_on, is_on + 4, false) - is_on);
    return 0.5 * (double{disparity_px[missing ^ 1U]} + double{disparity_px[missing ^ 2U]});
  }
  double sum = 0;
  for (unsigned k = 0; k < 4; ++k) {
    sum += is_on[k] ? double{disparity_px[k]} : 0.0;
  }
  return sum / static_cast<double>(count);
}

// Derivatives (∂u, ∂v) · λ of points at infinity along x (k = 0) or y (k = 1).
EdgeDirection direction_of(const ViewProjection& view, double x, double y, int k) {
  double far[9];  // homography of the points at infinity
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      far[3 * row + column] = view.homography[3 * row + column] +
                              (column == 2 ? view.infinity_disparity_px * view.parallax[row] : 0.0);
    }
  }
  const auto at = [&](int row) {
    return far[3 * row] * x + far[3 * row + 1] * y + far[3 * row + 2];
  };
  const double depth_ratio = at(2);
  const double rise_u = far[k] * depth_ratio - far[6 + k] * at(0);
  const double rise_v = far[3 + k] * depth_ratio - far[6 + k] * at(1);
  const bool along_lines =
      k == 0 ? std::abs(rise_v) > std::abs(rise_u) : std::abs(rise_v) >= std::abs(rise_u);
  return {.along_lines = along_lines, .sign = (along_lines ? rise_v : rise_u) >= 0 ? 1 : -1};
}

}  // namespace

EdgeDirection right_edge_direction(const ViewProjection& view, double x, double y) {
  return direction_of(view, x, y, 0);
}

EdgeDirection lower_edge_direction(const ViewProjection& view, double x, double y) {
  return direction_of(view, x, y, 1);
}

Quad quad_at(const SplatRows& rows, int i) {
  return {.a = corner_of(rows, rows.upper, i, rows.line),
          .b = corner_of(rows, rows.upper, i + 1, rows.line),
          .c = corner_of(rows, rows.lower, i, rows.line + 1),
          .d = corner_of(rows, rows.lower, i + 1, rows.line + 1)};
}

void fill_quad_gaps(const SplatRows& rows, const Quad& quad, const SplatBand& band) {
  const auto& [a, b, c, d] = quad;
  // False for dropped points: their disparity is NaN.
  const auto joined = [&](const Corner& p, const Corner& q) {
    return std::abs(p.disparity_px - q.disparity_px) <= rows.gradient_limit_px;
  };
  const bool ab = joined(a, b);
  const bool ac = joined(a, c);
  // Edges are traversed from the side that ordered forward mapping processes first.
  if (ab && is_gap(a, b, rows.right_edge)) {
    const bool forward = rows.view.parallax[0] <= 0;
    fill_edge(forward ? a : b, forward ? b : a, rows.right_edge, band);
  }
  if (ac && is_gap(a, c, rows.lower_edge)) {
    const bool forward = rows.view.parallax[1] <= 0;
    fill_edge(forward ? a : c, forward ? c : a, rows.lower_edge, band);
  }
  if (rows.view.is_translation && rows.view.parallax[1] == 0) {
    return;  // nothing lies between two rows
  }
  const bool bd = joined(b, d);
  const bool cd = joined(c, d);
  if (ab && ac && bd && cd) {
    fill_triangle(a, b, c, &d, band);
    fill_triangle(b, d, c, &a, band);
    return;
  }
  if (ab && ac) {
    fill_triangle(a, b, c, nullptr, band);
  }
  if (ab && bd) {
    fill_triangle(a, b, d, nullptr, band);
  }
  if (ac && cd) {
    fill_triangle(a, d, c, nullptr, band);
  }
  if (bd && cd) {
    fill_triangle(b, d, c, nullptr, band);
  }
}

bool is_torn(const SplatRows& rows, int i) {
  const float a = rows.upper.disparity_px[i];
  const float b = rows.upper.disparity_px[i + 1];
  const float c = rows.lower.disparity_px[i];
  const float d = rows.lower.disparity_px[i + 1];
  const auto joined = [&](float p, float q) { return std::abs(p - q) <= rows.gradient_limit_px; };
  return !(joined(a, b) && joined(a, c) && joined(b, d) && joined(c, d));
}

void fill_torn_quad(const SplatRows& rows, int i, const SplatBand& band) {
  const ViewProjection& view = rows.view;
  // By corner: bit 0 is right, bit 1 is below.
  const float disparity_px[4] = {rows.upper.disparity_px[i], rows.upper.disparity_px[i + 1],
                                 rows.lower.disparity_px[i], rows.lower.disparity_px[i + 1]};
  bool is_joined[4][4];
  for (unsigned k = 0; k < 4; ++k) {
    for (const unsigned next : {k ^ 1U, k ^ 2U}) {
      is_joined[k][next] = std::abs(disparity_px[k] - disparity_px[next]) <= rows.gradient_limit_px;
    }
  }
  const auto mean = [&](unsigned p, unsigned q) {
    return 0.5 * (double{disparity_px[p]} + double{disparity_px[q]});
  };
  const double left = rows.first_column + i;
  const double top = rows.line;
  for (unsigned k = 0; k < 4; ++k) {
    const double own{disparity_px[k]};
    if (std::isnan(own)) {
      continue;
    }
    const unsigned beside = k ^ 1U;
    const unsigned across = k ^ 2U;
    const unsigned opposite = k ^ 3U;
    bool is_on[4] = {};
    is_on[k] = true;
    is_on[beside] = is_joined[k][beside] || (is_joined[k][across] && is_joined[across][opposite] &&
                                             is_joined[opposite][beside]);
    is_on[across] = is_joined[k][across] || (is_joined[k][beside] && is_joined[beside][opposite] &&
                                             is_joined[opposite][across]);
    is_on[opposite] = (is_on[beside] && is_joined[beside][opposite]) ||
                      (is_on[across] && is_joined[across][opposite]);
    // The quarter of the quad at the corner.
    Corner quarter[4];
    bool is_before = true;
    const auto set = [&](unsigned place, double x, double y, double d) {
      const ExactTarget at = exact_target(view, x, y, d);
      is_before = is_before && at.depth_ratio > kMinDepthRatio;
      quarter[place].u = at.u;
      quarter[place].v = at.v;
      quarter[place].nearness =
          static_cast<float>((d - view.infinity_disparity_px) * (1 / at.depth_ratio));
    };
    const double x = left + (k & 1U);
    const double y = top + (k >> 1U);
    set(k, x, y, own);
    set(beside, left + 0.5, y, is_joined[k][beside] ? mean(k, beside) : own);
    set(across, x, top + 0.5, is_joined[k][across] ? mean(k, across) : own);
    set(opposite, left + 0.5, top + 0.5, middle_disparity(is_on, disparity_px));
    if (is_before) {
      fill_part(quarter, band);
    }
  }
}

}  // namespace vantage::kernels
