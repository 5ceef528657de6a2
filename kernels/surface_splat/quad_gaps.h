#pragma once

#include "kernels/surface_splat/surface_splat.h"

namespace vantage::kernels {

/// Where a pixel lands.
struct QuadCorner {
  double u = 0;
  double v = 0;
  float nearness = 0;
  float disparity_px = 0;
  int column = 0;  ///< u and v rounded
  int line = 0;
};

/// Positions so little outside the range of a triangle's targets are still looked at: more than
/// rounding can move one.
inline constexpr double kOutsidePx = 1e-3;

/// The least whole number from a target on, and the largest up to it, given what it is rounded to.
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

/// Whether the quad of upper columns i and i + 1 is not one surface.
bool is_torn(const SplatRows& rows, int i);

/// What splat_rows() adds to such a quad in views that are no translations.
void fill_torn_quad(const SplatRows& rows, int i, const SplatBand& band);

/// What it adds between the pixels of all others. Few quads lack something, so this and the former
/// are plain code for all instruction sets.
void fill_quad_gaps(const SplatRows& rows, const Quad& quad, const SplatBand& band);

}  // namespace vantage::kernels
