#pragma once

#include <optional>
#include <string_view>

namespace vantage {

/// Signed, inclusive range of candidate disparities in pixels, d = x_left − x_right.
struct DisparityRange {
  int min = 0;
  int max = 63;
  [[nodiscard]] int count() const { return max - min + 1; }
  friend bool operator==(DisparityRange, DisparityRange) = default;
};

enum class MatchMethod { kSsd };
enum class Subpixel { kParabola, kNone };
enum class Border { kValid, kClip };
/// Which image's grid the primary map is on.
enum class Reference { kLeft, kRight };

/// Everything that decides what a pair's disparity maps are. Defaults are the command line's.
struct MatchOptions {
  MatchMethod method = MatchMethod::kSsd;
  DisparityRange disparities;  ///< at most 4096 candidates
  int window_px = 9;           ///< side of the square window of SSD, odd, 1..181
  Subpixel subpixel = Subpixel::kParabola;
  Border border = Border::kClip;
  Reference reference = Reference::kLeft;
  /// Winner-take-all only: no cross-check, no fill (sub-pixel stays as set above).
  bool raw = false;
  /// Largest |d_left − d_right| that still counts as agreement, ≥ 1 (5.13); default max(1, D/15).
  std::optional<double> cross_check_px;
  /// Matched regions of fewer pixels than this count as unmatched; ≥ 0, 0 and 1: none do.
  int speckle_size_px = 0;

  /// Throws UsageError naming the field, its value and its limit.
  void validate() const;
  [[nodiscard]] double cross_check_or_default() const;
};

}  // namespace vantage
