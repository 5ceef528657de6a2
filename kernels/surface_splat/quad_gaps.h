#pragma once

#include "kernels/surface_splat/surface_splat.h"

namespace vantage::kernels {

/// Target of a pixel.
struct QuadCorner {
  double u = 0;
  double v = 0;
  float nearness = 0;
  float disparity_px = 0;
  int column = 0;  ///< u and v rounded
  int line = 0;
};

/// Positions outside the range of a triangle's targets by at most this are still tested: more than
/// rounding can move a target.
inline constexpr double kOutsidePx = 1e-3;

/// Smallest integer ≥ a target and largest integer ≤ it, given the rounded target.
inline int first_whole(double target, int rounded) {
  return rounded + (target - kOutsidePx > rounded ? 1 : 0);
}
inline int last_whole(double target, int rounded) {
  return rounded - (target + kOutsidePx < rounded ? 1 : 0);
}

/// Two neighbours of the upper row and the pixels below them.
struct Quad {
  QuadCorner a;
  QuadCorner b;
  QuadCorner c;
  QuadCorner d;
};

/// The quad of upper columns i and i + 1.
Quad quad_at(const SplatRows& rows, int i);

/// Whether the quad of upper columns i and i + 1 is not a single surface.
bool is_torn(const SplatRows& rows, int i);

/// Adds the samples of splat_rows() for such a quad, in views that are not translations.
void fill_torn_quad(const SplatRows& rows, int i, const SplatBand& band);

/// Adds the samples between the pixels of all other quads. Few quads have gaps, so this and
/// fill_torn_quad() are scalar code.
void fill_quad_gaps(const SplatRows& rows, const Quad& quad, const SplatBand& band);

}  // namespace vantage::kernels
