#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "engine/image/image.h"

namespace vantage {

/// A pixel of an image.
struct PixelPosition {
  int x = 0;
  int y = 0;
};

/// Patches of texture synthesis are squares of 9×9 pixels.
constexpr int kPatchRadiusPx = 4;
constexpr int kPatchPx = 2 * kPatchRadiusPx + 1;

/// What the synthesis of all holes of an image shares.
struct HoleImage {
  Image<std::uint8_t> levels;   ///< R, G, B and 0 of each pixel, or three times its grey level
  Image<std::int32_t> labels;   ///< number of the pixel's hole; 0: none
  Image<float> confidence;      ///< of pixels whose values count: 1, less in filled holes; else 0
  Image<std::int32_t> blocked;  ///< number of pixels of holes above and left, (w + 1)×(h + 1)
  ImageView<const float> disparity_px = {};
  float limit_px = 1;
  int step_px = 1;  ///< of the first search
};

/// A patch to be continued: where its values count, and what they are.
class TargetPatch {
 public:
  /// Values count that are of the background of `centre`, which belongs to a hole.
  TargetPatch(const HoleImage& holes, PixelPosition centre);

  /// Mean confidence, 0..1.
  [[nodiscard]] float confidence() const { return confidence_; }
  /// Sum of squared differences to the patch around a pixel at least a radius inside the image;
  /// empty if that contains holes, or pixels nearer than the background or (`is_same_surface`) far
  /// beyond it; anything above `limit` where it is above.
  [[nodiscard]] std::optional<std::int64_t> difference(PixelPosition source, bool is_same_surface,
                                                       std::int64_t limit) const;

 private:
  static constexpr std::size_t kBytes = 4 * kPatchPx;

  const HoleImage& holes_;
  float nearest_px_;
  float farthest_px_;
  float confidence_ = 0;
  std::uint8_t values_[kPatchPx][kBytes] = {};
  std::uint8_t counts_[kPatchPx][kBytes] = {};  ///< 255 or 0
};

/// The pixel around which the patch is most like `target`, of the background beside the hole;
/// empty: none.
std::optional<PixelPosition> find_source(const HoleImage& holes, const TargetPatch& target,
                                         PixelPosition centre);

}  // namespace vantage
