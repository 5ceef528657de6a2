#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

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
  double mean_squared_difference = 0;   ///< likewise
  /// Mean structural similarity of luma over all full 11×11 windows, −1..1; ignores the mask. Empty
  /// when the picture is narrower or lower than a window.
  std::optional<double> ssim;
};

/// PSNR of a mean squared difference in grey levels; +inf for 0.
double psnr_db(double mean_squared_difference);

/// Channels in which two pictures are compared: 3 if both are in colour, else 1, their luma.
int compared_channels(const Photograph& a, const Photograph& b);
/// Row y in grey levels 0..255: `channels` colours interleaved, or the luma (Rec. 601) for one.
void read_level_row(const Photograph& photograph, int y, int channels, std::vector<double>& levels);
/// Throws Error unless `what` has the size of `truth`.
void require_equal_size(const char* what, int width, int height, const Photograph& truth);

/// Compares two photographs of equal size; depths may differ. Alpha is ignored. When one is grey
/// and the other in colour, the luma (Rec. 601) of the latter is compared. PSNR and the mean
/// difference use the pixels whose mask value is 255 (no mask: all). SSIM is that of Wang, Bovik,
/// Sheikh, Simoncelli 2004: Gaussian window of σ 1.5, K1 = 0.01, K2 = 0.03.
///
/// Errors: Error when sizes differ or no pixel is selected. Thread rule: pure; the result is
/// identical for any ExecutionOptions.
ViewScores evaluate_view(const Photograph& view, const Photograph& truth, Execution& execution,
                         std::optional<ImageView<const std::uint8_t>> mask = {});

/// How much views change from frame to frame where the truth does not, or not so: the mean over
/// pixels, colours (or luma) and frames of |(view_t − view_t−1) − (truth_t − truth_t−1)|, in grey
/// levels 0..255. A constant error does not flicker. Thread rule: one call at a time.
class ViewFlicker {
 public:
  /// The next frame of both. Pixels that are 255 in its mask or in that of the frame before are
  /// also counted by themselves. Throws Error when sizes or colours differ from those before.
  void add(const Photograph& view, const Photograph& truth,
           std::optional<ImageView<const std::uint8_t>> mask = {});

  /// The mean over all pixels, and over masked pixels only. None before the second frame, or where
  /// no pixel counts.
  [[nodiscard]] std::optional<double> mean_levels() const { return mean_of(0); }
  [[nodiscard]] std::optional<double> masked_mean_levels() const { return mean_of(1); }

 private:
  [[nodiscard]] std::optional<double> mean_of(std::size_t pixels) const;

  Image<float> errors_;  ///< view − truth of the last frame; empty: none yet
  Mask mask_;            ///< of the last frame, if it had one
  std::array<double, 2> levels_{};
  std::array<std::int64_t, 2> values_{};
};

}  // namespace vantage
