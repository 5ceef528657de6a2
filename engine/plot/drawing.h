#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <variant>
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

/// An open line through at least two points.
struct StrokeShape {
  std::vector<DrawingPoint> points;
  Colour colour;
  double width = 1;
};

/// A filled polygon with a thin outline, convex.
struct PolygonShape {
  std::vector<DrawingPoint> corners;
  Colour fill;
  Colour outline;
};

/// A filled disc.
struct DiscShape {
  DrawingPoint centre;
  double radius = 1;
  Colour colour;
};

/// A filled rectangle.
struct BoxShape {
  DrawingPoint corner;  ///< minimum x and y
  double width = 0;
  double height = 0;
  Colour colour;
};

/// One line of text, ASCII only: rasterize() has no other characters.
struct TextShape {
  enum class Anchor { kBegin, kMiddle, kEnd };
  DrawingPoint baseline;  ///< at the text's start, middle or end
  std::string text;
  double size = 12;  ///< font height
  Anchor anchor = Anchor::kBegin;
  Colour colour;
};

/// A small picture, 8-bit RGB, scaled without smoothing.
struct PictureShape {
  DrawingPoint corner;
  double width = 0;
  double height = 0;
  Image<std::uint8_t> rgb;
};

using DrawingShape =
    std::variant<StrokeShape, PolygonShape, DiscShape, BoxShape, TextShape, PictureShape>;

/// Shapes on a white background, painted in order.
struct Drawing {
  int width = 0;  ///< drawing units
  int height = 0;
  std::vector<DrawingShape> shapes;
};

/// Approximate width of a text.
double text_width(const std::string& text, double size);

/// A complete SVG document; pictures are embedded as PNG.
std::string to_svg(const Drawing& drawing);

/// 8-bit RGB, anti-aliased, `pixels_per_unit` ≥ 1 times as large as the drawing.
Image<std::uint8_t> rasterize(const Drawing& drawing, int pixels_per_unit);

/// Writes .svg, or a picture of two pixels per unit in any format of write_photograph(),
/// atomically. Throws as write_photograph() does.
void write_drawing(const std::filesystem::path& path, const Drawing& drawing);

}  // namespace vantage
