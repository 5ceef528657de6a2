#pragma once

#include <array>
#include <optional>
#include <string_view>
#include <vector>

#include "engine/execution.h"
#include "engine/image/photograph.h"
#include "engine/matching/estimation/evidence_pair.h"
#include "engine/matching/options/match_options.h"

namespace vantage {

/// The whole left image or one of its quadrants; they meet at half the width and height, rounded
/// down.
enum class ImagePart { kWhole, kTopLeft, kTopRight, kBottomLeft, kBottomRight };
inline constexpr std::array<std::string_view, 5> kImagePartNames = {
    "whole", "top-left", "top-right", "bottom-left", "bottom-right"};

struct CumulativeResponseOptions {
  /// Displacements left − right; at most kMaxDisplacements in total. Outside the image the sum is
  /// 0.
  DisparityRange displacements_x;
  DisparityRange displacements_y = {0, 0};
  /// Uses alpha, norm, gradient and prefilter.
  MethodParameters parameters = book_parameters(MatchMethod::kGradient);

  static constexpr int kMaxDisplacements = 1 << 20;
  /// Throws UsageError naming the field, its value and its limit.
  void validate() const;
};

/// ΣE over an image and its quadrants for a grid of displacements (5.5.1).
struct CumulativeResponse {
  DisparityRange displacements_x;
  DisparityRange displacements_y;
  int width_px = 0;  ///< of the images
  int height_px = 0;
  /// By ImagePart; rows of equal y displacement, contiguous, starting at the smallest.
  std::array<std::vector<double>, 5> surfaces;

  [[nodiscard]] double at(ImagePart part, Displacement displacement) const;
  /// Number of pixels of a part.
  [[nodiscard]] double pixels(ImagePart part) const;
  /// Maximum of the surface, ties going to the first, among the displacements for which at least
  /// half of the part's pixels have a partner, because sums over fewer pixels are always small.
  /// None if there is no such displacement, or all have equal sums.
  [[nodiscard]] std::optional<Displacement> dominant(ImagePart part) const;
};

/// Throws UsageError for invalid options, Error when sizes differ. Identical for any `execution`
/// and on every instruction set. Thread rule: may be called concurrently.
CumulativeResponse cumulative_response(const Photograph& left, const Photograph& right,
                                       const CumulativeResponseOptions& options,
                                       Execution& execution);

}  // namespace vantage
