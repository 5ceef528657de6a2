#pragma once

#include <array>
#include <optional>

#include "engine/image/disparity_maps.h"
#include "engine/image/photograph.h"

namespace vantage {

/// Shares of the pixels that have at most a FrameComfort::disparity, in order; the first is the
/// smallest disparity (farthest), the last the largest (nearest).
inline constexpr std::array kComfortShares = {0.0,  0.001, 0.005, 0.01,  0.02, 0.05,
                                              0.1,  0.25,  0.5,   0.75,  0.9,  0.95,
                                              0.98, 0.99,  0.995, 0.999, 1.0};
/// Units of the whole numbers in FrameComfort.
inline constexpr int kComfortPerPixel = 64;
inline constexpr int kComfortPerGreyLevel = 64;
inline constexpr int kComfortWhole = 10000;

/// What a stereo film does to its viewers in one frame, without judgement. Whole numbers, so that
/// stored and fresh values are the same. Disparities are x_left − x_right: positive is crossed, in
/// front of the screen.
struct FrameComfort {
  int width_px = 0;
  int height_px = 0;
  int matched = 0;  ///< share of the pixels with a match, in 1/kComfortWhole
  std::array<int, kComfortShares.size()> disparity = {};  ///< in 1/kComfortPerPixel px
  /// At the left and at the right border: the share of rows where something in front of the screen
  /// is cut, in 1/kComfortWhole, and its largest disparity, in 1/kComfortPerPixel px.
  struct Border {
    int rows = 0;
    int disparity = 0;
    friend bool operator==(const Border&, const Border&) = default;
  };
  std::array<Border, 2> borders = {};
  /// y_left − y_right where the images show the same points: its mean and the RMS of its smooth
  /// part (see VerticalError), in 1/kComfortPerPixel px; empty if there are too few points.
  struct Vertical {
    int mean = 0;
    int systematic = 0;
    friend bool operator==(const Vertical&, const Vertical&) = default;
  };
  std::optional<Vertical> vertical;
  /// Places where one image hides something, by the side that the hidden colours belong to: as they
  /// should, and as if left and right were exchanged.
  int order_right = 0;
  int order_wrong = 0;
  /// Mean of left − right over matched pixels, in 1/kComfortPerGreyLevel levels of 255: red, green,
  /// blue; grey images have the same three.
  std::array<int, 3> colour = {};

  friend bool operator==(const FrameComfort&, const FrameComfort&) = default;
};

/// Measures a rectified pair of equal size by the map of its left (`side` kLeft) or right image.
/// Pixels without a match count nowhere. Thread rule: may be called concurrently.
FrameComfort measure_comfort(const Photograph& left, const Photograph& right, const MatchedMap& map,
                             Side side);

}  // namespace vantage
