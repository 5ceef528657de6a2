#pragma once

namespace vantage::kernels {

/// One scanline of a disparity map on its way to a new view on the baseline (YS = 0).
struct ForwardWarpRow {
  const float* disparity_px = nullptr;  ///< `width` values; NaN or ±inf = unknown
  int width = 0;                        ///< 0..2²⁰
  double camera_offset = 0;             ///< s = XS − position of the source camera, in baselines
  float gradient_limit_px = 1;          ///< neighbours that differ by at most this are one surface
};

/// Ordered forward mapping (3.5): pixel x lands on floor(x − s·d + ½) = x + floor(½ − s·d). Columns
/// are walked upward iff s ≥ 0 and later writes win.
///
/// Writes `width` values to each output: the disparity seen at each position of the new view, NaN
/// where nothing lands, and the source column it comes from, NaN likewise; `source_column` may be
/// null. Outputs must not overlap the input. Positions between the
/// targets of neighbours of one surface are sampling gaps, not holes: they get the disparity and
/// the fractional source column interpolated between the two.
///
/// The result equals a z-buffer on d over all samples, without ever comparing two. floor(½ − s·d)
/// is the same number for equal d and monotone in d, in floating point too; so two pixels can meet
/// on one position only if the one walked later has the strictly larger d: there are no ties. An
/// interpolated sample lies exactly at its position and between two pixels that do not land there,
/// so a pixel that meets it is more than one column away, which rounding (half a column) cannot
/// outweigh, and two interpolated ones differ in d as they differ in column.
/// Only the targets are computed in vectors: the scatter has an order. Identical on every
/// instruction set and to the reference.
void forward_warp_row(const ForwardWarpRow& row, float* warped_disparity_px, float* source_column);
void forward_warp_row_ref(const ForwardWarpRow& row, float* warped_disparity_px,
                          float* source_column);

}  // namespace vantage::kernels
