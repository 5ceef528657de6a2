#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "engine/image/image.h"

namespace vantage {

/// 8-bit RGB.
struct Colour {
  std::uint8_t red = 0;
  std::uint8_t green = 0;
  std::uint8_t blue = 0;
};

/// A position in a drawing: x to the right, y down, in drawing units (pixels of its SVG file).
struct DrawingPoint {
  double x = 0;
  double y = 0;
};

enum class TextAnchor { kBegin, kMiddle, kEnd };

inline constexpr Colour kInk{40, 40, 40};
inline constexpr double kTextSize = 11;

/// Shapes on a white background, painted in the order in which they are added.
class Drawing {
 public:
  /// An open line through at least two points.
  void stroke(const std::vector<DrawingPoint>& points, double line_width = 1, Colour colour = kInk);
  void disc(DrawingPoint centre, double radius, Colour colour);
  /// One line, with its start, middle or end at `baseline`. What is not ASCII becomes "?".
  void text(DrawingPoint baseline, std::string text, TextAnchor anchor = TextAnchor::kBegin,
            double size = kTextSize);
  /// A small picture, 8-bit RGB, scaled to `columns`×`rows` drawing units without smoothing and
  /// embedded as PNG.
  /// Throws Error if it cannot be encoded.
  void picture(DrawingPoint corner, double columns, double rows, const Image<std::uint8_t>& rgb);

  /// The SVG element; documents need the declaration of XML before it.
  [[nodiscard]] std::string svg() const;

  int width = 0;  ///< drawing units
  int height = 0;

 private:
  std::string shapes_;
};

/// Approximate width of a text.
double text_width(const std::string& text, double size);

}  // namespace vantage
