#pragma once

namespace vantage::kernels {

/// One row of anisotropic diffusion of grey levels (Perona and Malik): output = I + 0.2 Σ c_n (I_n
/// − I) over the four neighbours, with the conductance c_n = exp(−|I_n − I| / contrast): small
/// differences fade, large ones stay. A neighbour outside the image has no effect. What a pixel
/// gets its neighbour gives. Identical on every instruction set.
struct IntensityDiffusionRow {
  const float* up = nullptr;  ///< null: outside the image; so is down
  const float* centre = nullptr;
  const float* down = nullptr;
  int width = 0;            ///< ≥ 1
  float contrast = 8;       ///< grey levels, > 0
  float* work = nullptr;    ///< intensity_diffusion_work_floats()
  float* output = nullptr;  ///< must not overlap the input
};

constexpr int intensity_diffusion_work_floats(int width) { return 3 * (width + 1); }

void intensity_diffusion_row(const IntensityDiffusionRow& row);

}  // namespace vantage::kernels
