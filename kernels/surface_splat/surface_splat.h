#pragma once

#include <cstddef>

#include "kernels/view_projection/view_projection.h"

namespace vantage::kernels {

/// Axis of the new view along which the gap between two neighbours is filled: the one along which
/// their targets would be farther apart without parallax.
struct EdgeDirection {
  bool along_lines = false;  ///< true: v; false: u
  int sign = 1;  ///< targets of neighbours on one surface increase (1) or decrease (−1)
};

/// Directions for pixels and their right and lower neighbours, from the points at infinity around
/// pixel (x, y), the centre of the image. Thread rule: pure.
EdgeDirection right_edge_direction(const ViewProjection& view, double x, double y);
EdgeDirection lower_edge_direction(const ViewProjection& view, double x, double y);

/// Two neighbouring rows of an image to be mapped to a new view. Rows have `count` + 1 values, as
/// written by project_row(); values outside the image are dropped points. kSplatPadding more values
/// must be readable; they may hold anything.
struct SplatRows {
  ViewProjection view;
  ProjectedRow upper;
  ProjectedRow lower;
  int count = 0;  ///< pixels of the upper row that are samples and corners of quads
  int first_column = 0;
  int line = 0;  ///< of the upper row
  EdgeDirection right_edge;
  EdgeDirection lower_edge{.along_lines = true};
  float gradient_limit_px = 1;  ///< neighbours that differ by at most this are on one surface
};
inline constexpr int kSplatPadding = 64;

/// A band of lines of a new view.
struct SplatBand {
  float* nearness = nullptr;  ///< first line of the band; −inf where nothing has landed
  std::ptrdiff_t stride = 0;  ///< values between lines; lines · stride < 2³¹
  int width = 0;
  int first_line = 0;
  int lines = 0;
};

/// Forward mapping of disparity into a z-buffer on nearness, which keeps the maximum of all
/// samples:
/// - every pixel, at its target;
/// - between a pixel and its right or lower neighbour on one surface: every position between their
///   (rounded) targets along the edge's axis; the other coordinate is rounded;
/// - in a quad of four pixels: every position inside the triangles of (exact) targets on one
///   surface, borders included. A triangle is a corner and the two adjacent ones, if both belong to
///   it. If all four belong together, the triangles are those of the first and last corner. The
///   targets of the corners that belong together are left out, and so are triangles whose targets
///   are at most one column and line apart: nothing lies in them.
/// Between samples q is interpolated linearly over the new view, which is exact for planes.
/// Surfaces seen from behind (targets in reverse order, triangles of the opposite orientation) have
/// no gaps to fill. In translations along rows a line depends on its row alone and equals the
/// result of forward_warp_row().
///
/// A translation does not change the size of pixels, so holes are disocclusions. Any other view
/// also spreads pixels. There a torn quad (not one surface; unknown pixels belong to none) is
/// divided among its corners: each known one gets the quarter of the quad next to it, and every
/// position inside the quarter's two triangles is a sample. At the quarter's corners the surface
/// has: at the pixel, the pixel's disparity; on an edge of the quad, the mean of the two pixels if
/// joined, else the pixel's own; in the middle of the quad, the mean of all its pixels that
/// neighbours join to this one (with three, of the two that are not adjacent). So each surface
/// extends half an image pixel beyond its last pixels, at any magnification.
///
/// Adds the upper row's pixels, their edges and the quads between the rows. Since the maximum is
/// kept, neither the order of calls nor the division of a view into bands matters. Identical on
/// every instruction set.
void splat_rows(const SplatRows& rows, const SplatBand& band);

}  // namespace vantage::kernels
