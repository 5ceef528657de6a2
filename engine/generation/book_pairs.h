#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "engine/image/image.h"
#include "engine/image/photograph.h"
#include "engine/matching/options/match_options.h"

namespace vantage {

enum class BookPattern {
  kRamp,        ///< rises by 2.5 grey levels per pixel along x, or less to stay within 0..255
  kRandomDots,  ///< 64 or 192 with equal probability, one pixel per dot
  kGrass        ///< grass-like noise of standard deviation 22 about 112
};

enum class BookShape {
  kSquare,  ///< a square in front of a background
  kBars     ///< a rectangle above, and below it a bar displaced by more than twice its width
};

/// One of the synthetic pairs of the book's chapter 6 (EQUATIONS §4). Defaults are its
/// experiments'.
struct BookPairOptions {
  BookPattern pattern = BookPattern::kRandomDots;
  BookShape shape = BookShape::kSquare;  ///< not kBars with kRamp: no unique match
  int width_px = 100;                    ///< 1..16384; shapes take fixed fractions of the image
  int height_px = 100;                   ///< 1..16384
  int background_disparity_px = 2;       ///< −4096..4096
  /// Disparity of the front relative to the background; default 6 (square) or 7 (bars).
  std::optional<int> front_disparity_px = std::nullopt;
  /// Disparity of the narrow bar relative to the front; default 16.
  std::optional<int> narrow_disparity_px = std::nullopt;
  double noise_sigma = 0;     ///< grey levels, Gaussian, independent in both images; 0..255
  bool float_pixels = false;  ///< float pixels even without noise (noise always gives them)
  /// The image whose grid the shapes are placed on. For kRamp the other one is the unbroken ramp.
  Side reference = Side::kLeft;
  std::uint64_t seed = 1;

  /// Throws UsageError naming the field, its value and its limit.
  void validate() const;
  [[nodiscard]] int front_disparity_or_default() const;
  [[nodiscard]] int narrow_disparity_or_default() const;
};

/// A grey pair with its truth. Float pixels are grey levels / 255, neither rounded nor clipped, so
/// noise can take them outside 0..1.
struct BookPair {
  Photograph left;
  Photograph right;
  DisparityMap left_disparity;  ///< known everywhere
  DisparityMap right_disparity;
  Mask left_occluded;  ///< 255 where the partner is occluded in, or outside, the other image
  Mask right_occluded;
  DisparityRange search;  ///< 0..9 and 0..19 for the default pairs
};

/// Names of the book's five pairs: ramp-square, rds-square, real-square, rds-bars, real-bars.
inline constexpr std::array<std::string_view, 5> kBookPairNames = {
    "ramp-square", "rds-square", "real-square", "rds-bars", "real-bars"};

/// The default options of a named pair. Throws UsageError that lists the known names.
BookPairOptions book_pair_options(std::string_view name);

/// Equal options give equal pictures on every platform. Throws UsageError for invalid options.
/// Thread rule: pure.
BookPair make_book_pair(const BookPairOptions& options);

}  // namespace vantage
