#pragma once

namespace vantage::kernels {

/// values[x] = `row` at x + fraction, 0 < fraction < 1, by bicubic interpolation (Keys, a = −½)
/// within the range of the four pixels around it. Pixels outside the row of `width` take the border
/// value. The rows do not overlap.
void resample_row(const float* row, int width, float fraction, float* values);

}  // namespace vantage::kernels
