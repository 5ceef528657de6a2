#pragma once

namespace vantage::kernels {

/// One scanline of a disparity map to be warped to a new view on the baseline (YS = 0).
struct ForwardWarpRow {
  const float* disparity_px = nullptr;  ///< `width` values; NaN or ±inf = unknown
  int width = 0;                        ///< 0..2²⁰
  double camera_offset = 0;             ///< s = XS − position of the source camera, in baselines
  float gradient_limit_px = 1;  ///< neighbours that differ by at most this are on one surface
};

/// Ordered forward mapping (3.5): pixel x lands on floor(x − s·d + ½) = x + floor(½ − s·d). Columns
/// are processed in ascending order iff s ≥ 0, and later writes win.
///
/// Writes `width` values to each output: the disparity seen at each position of the new view, and
/// the source column it comes from; both NaN where nothing lands. `source_column` may be null.
/// Outputs must not overlap the input. Positions between the targets of neighbours on one surface
/// are sampling gaps, not holes: they get the interpolated disparity and the fractional source
/// column.
///
/// The result equals a z-buffer on d over all samples, without comparisons. floor(½ − s·d) is the
/// same number for equal d and monotone in d, in floating point too. So two pixels can meet on one
/// position only if the later one has the strictly larger d: there are no ties. An interpolated
/// sample lies exactly at its position, between two pixels that do not land there. So a pixel that
/// meets it is more than one column away, which rounding (half a column) cannot outweigh; two
/// interpolated samples differ in d as they differ in column.
/// Only the targets are computed in vectors: the scatter is ordered. Identical on every instruction
/// set.
void forward_warp_row(const ForwardWarpRow& row, float* warped_disparity_px, float* source_column);

}  // namespace vantage::kernels
