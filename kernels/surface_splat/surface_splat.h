#pragma once

#include <cstddef>

#include "kernels/view_projection/view_projection.h"

namespace vantage::kernels {

/// Along which axis of the new view the gap between two neighbours is walked: the one in which
/// their targets would be farther apart without parallax.
struct EdgeDirection {
  bool along_lines = false;  ///< v, else u
  int sign = 1;              ///< targets of neighbours of one surface rise (1) or fall (−1)
};

/// For pixels and their right and lower neighbours, as the points at infinity are seen around the
/// pixel (x, y), the centre of the image. Thread rule: pure.
EdgeDirection right_edge_direction(const ViewProjection& view, double x, double y);
EdgeDirection lower_edge_direction(const ViewProjection& view, double x, double y);

/// Two neighbouring rows of an image on their way into a new view. Rows have `count` + 1 values, as
/// project_row() makes them; those that do not exist are points that it drops. Beyond these,
/// kSplatPadding more values must be readable, whatever they hold.
struct SplatRows {
  ViewProjection view;
  ProjectedRow upper;
  ProjectedRow lower;
  int count = 0;  ///< pixels of the upper row that are samples and corners of quads
  int first_column = 0;
  int line = 0;  ///< of the upper row
  EdgeDirection right_edge;
  EdgeDirection lower_edge{.along_lines = true};
  float gradient_limit_px = 1;  ///< neighbours that differ by at most this are one surface
};
inline constexpr int kSplatPadding = 64;

/// Some lines of a new view.
struct SplatBand {
  float* nearness = nullptr;  ///< of its first line; −inf where nothing has landed
  std::ptrdiff_t stride = 0;  ///< values from one line to the next; lines · stride < 2³¹
  int width = 0;
  int first_line = 0;
  int lines = 0;
};

/// Forward mapping of disparity into a z-buffer on nearness, which keeps the largest of all
/// samples:
/// - every pixel, where it lands;
/// - between a pixel and its right or lower neighbour on one surface, every position that lies
///   between their (rounded) targets along the edge's axis; its other coordinate is rounded;
/// - in a quad of four pixels, every position inside the triangles of (exact) targets that are one
///   surface, borders included: a corner and the two beside it, if both belong to it. Where all
///   four belong together, the triangles of the first and last corner. The targets of the corners
///   that belong together are left out, and so are triangles whose targets are no more than one
///   column and line apart: nothing lies in them.
/// Between samples q is interpolated linearly over the new view, which is exact for planes.
/// Surfaces seen from behind (targets in the opposite order, triangles that turn the other way)
/// have no gaps to fill. In translations along rows a line is made from the row alone, and equals
/// what forward_warp_row() makes of it.
///
/// A translation leaves pixels as large as they are, so that holes are what parallax opens. Any
/// other view also spreads them. There a quad that is torn (not one surface; unknown pixels belong
/// to none) is divided among its corners instead: each known one has the quarter of the quad beside
/// it, and every position inside the quarter's two triangles is a sample. At the corners of the
/// quarter the surface has the pixel's disparity, beside it the mean of two joined pixels or else
/// the pixel's own, and in the middle of the quad the mean of all of its pixels that neighbours
/// join to this one; of three, of the two that are not beside each other. So each surface reaches
/// half a pixel of the image beyond its last pixels, at any magnification.
///
/// The upper row's pixels, their edges and the quads between the rows are added. As the largest
/// value stays, neither the order of calls nor how a view is cut into bands makes a difference.
/// Identical on every instruction set and to the reference.
void splat_rows(const SplatRows& rows, const SplatBand& band);
void splat_rows_ref(const SplatRows& rows, const SplatBand& band);

}  // namespace vantage::kernels
