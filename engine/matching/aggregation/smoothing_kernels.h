#pragma once

#include <array>
#include <vector>

namespace vantage {

// Symmetric smoothing kernels, given by their weights from the centre outwards: element k is the
// weight of the samples k pixels away on either side. Normalised: w0 + 2 · (w1 + w2 + …) = 1.

/// exp(−k²/2σ²) for k = 0 … ⌈4σ⌉. sigma_px > 0.
std::vector<float> gaussian_kernel(double sigma_px);

/// Widths (odd, ascending) of Wells' cascade of four boxes: the sum of their variances (w² − 1)/12
/// is as close to σ² as odd widths allow; ties go to the most Gaussian (smallest fourth cumulant).
/// σ = 2: 3, 3, 3, 5, exactly.
std::array<int, 4> box_cascade_widths_px(double sigma_px);

/// The composite of boxes of odd widths, each divided by its width.
std::vector<float> box_cascade_kernel(const std::array<int, 4>& widths_px);

}  // namespace vantage
