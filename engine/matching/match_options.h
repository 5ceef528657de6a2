#pragma once

#include <optional>
#include <string_view>

#include "engine/matching/method_parameters.h"

namespace vantage {

/// Signed, inclusive range of candidate disparities in pixels, d = x_left − x_right.
struct DisparityRange {
  int min = 0;
  int max = 63;
  [[nodiscard]] int count() const { return max - min + 1; }
  friend bool operator==(DisparityRange, DisparityRange) = default;
};

/// Which image's grid the primary map is on.
enum class Reference { kLeft, kRight };
/// What unmatched pixels become.
enum class Fill {
  kConstant,  ///< the depth of the background beside them (EQUATIONS §5.4)
  kLinear,    ///< between both sides where their disparities nearly agree, else constant
  kNone,      ///< unknown
};

/// What is done to maps after the winners are chosen (EQUATIONS §5), in this order.
struct RefinementOptions {
  /// Moves discontinuities to intensity edges at most this far away; 0: leaves them; 0..16.
  int edge_snapping_px = 0;
  bool cross_check = true;
  /// Largest |d_left − d_right| that still counts as agreement, ≥ 1 (5.13); default max(1, D/15).
  std::optional<double> cross_check_px;
  /// Pixels with a confidence of at most this are unmatched (5.14); empty: 0 for gradient
  /// evidence, none otherwise. In the unit of the method's confidence.
  std::optional<double> confidence_threshold;
  /// Matched regions of fewer pixels than this count as unmatched; ≥ 0, 0 and 1: none do.
  int speckle_size_px = 0;
  Fill fill = Fill::kConstant;
};

/// Everything that decides what a pair's disparity maps are. Defaults are the command line's.
struct MatchOptions {
  MatchMethod method = MatchMethod::kSsd;
  /// Replaces `method` and the defaults of everything else that is not set.
  std::optional<MatchPreset> preset;
  DisparityRange disparities;  ///< at most 4096 candidates
  /// Vertical component of a two-dimensional search, y_left − y_right (5.5.3); empty: 0 only.
  std::optional<DisparityRange> disparities_y;
  MethodOverrides parameters;
  Reference reference = Reference::kLeft;
  /// Winner-take-all only: no refinement (sub-pixel stays as set above).
  bool raw = false;
  RefinementOptions refinement;

  /// What is in force: the fields of `parameters`, else the preset's, else the method's.
  [[nodiscard]] MethodParameters resolved() const;
  /// Throws UsageError naming the field, its value and its limit.
  void validate() const;
  [[nodiscard]] double cross_check_or_default() const;
};

}  // namespace vantage
