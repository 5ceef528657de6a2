#pragma once

#include <cstdint>
#include <optional>

#include "engine/execution.h"
#include "engine/image/image.h"
#include "engine/image/photograph.h"

namespace vantage {

/// Similarity of two pictures, on the scale of grey levels 0..255.
struct ViewScores {
  std::int64_t pixels = 0;  ///< evaluated for the two scores below, ≥ 1
  /// 10 log10(255² / mean squared difference), over pixels and channels; +inf for equal pictures.
  double psnr_db = 0;
  double mean_absolute_difference = 0;  ///< grey levels, over pixels and channels
  /// Mean structural similarity of luma over all full 11×11 windows, −1..1; ignores the mask. Empty
  /// when the picture is narrower or lower than a window.
  std::optional<double> ssim;
};

/// Compares two photographs of equal size; depths may differ. Alpha is ignored. When one is grey
/// and the other in colour, the luma (Rec. 601) of the latter is compared. PSNR and the mean
/// difference use the pixels whose mask value is 255 (no mask: all). SSIM is that of Wang, Bovik,
/// Sheikh, Simoncelli 2004: Gaussian window of σ 1.5, K1 = 0.01, K2 = 0.03.
///
/// Errors: Error when sizes differ or no pixel is selected. Thread rule: pure; the result is
/// identical for any ExecutionOptions.
ViewScores evaluate_view(const Photograph& view, const Photograph& truth, Execution& execution,
                         std::optional<ImageView<const std::uint8_t>> mask = {});

}  // namespace vantage
