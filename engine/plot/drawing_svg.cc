#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "engine/error.h"
#include "engine/io/files/base64.h"
#include "engine/io/files/markup_text.h"
#include "engine/io/images/png_encoder.h"
#include "engine/plot/drawing.h"

namespace vantage {
namespace {

// Control characters and bytes that may not be UTF-8 would make the document ill-formed.
std::string printable(std::string text) {
  std::ranges::replace_if(
      text, [](char letter) { return letter < ' ' || letter > '~'; }, '?');
  return text;
}

std::string png_of(const Image<std::uint8_t>& rgb) {
  std::vector<std::uint8_t> bytes;
  encode_png(rgb, bytes);
  if (bytes.empty()) {
    throw Error("a picture of a drawing cannot be encoded as PNG");
  }
  return encode_base64(bytes);
}

std::string hex(Colour colour) {
  return fmt::format("#{:02x}{:02x}{:02x}", colour.red, colour.green, colour.blue);
}

class SvgWriter {
 public:
  void operator()(const StrokeShape& stroke) {
    append(
        "<polyline fill=\"none\" stroke=\"{}\" stroke-width=\"{:.4g}\" "
        "stroke-linejoin=\"round\" points=\"",
        hex(stroke.colour), stroke.width);
    for (const DrawingPoint& point : stroke.points) {
      append("{:.2f},{:.2f} ", point.x, point.y);
    }
    text_ += "\"/>\n";
  }
  void operator()(const PolygonShape& polygon) {
    append("<polygon fill=\"{}\" stroke=\"{}\" stroke-width=\"0.4\" points=\"", hex(polygon.fill),
           hex(polygon.outline));
    for (const DrawingPoint& point : polygon.corners) {
      append("{:.1f},{:.1f} ", point.x, point.y);
    }
    text_ += "\"/>\n";
  }
  void operator()(const DiscShape& disc) {
    append("<circle cx=\"{:.2f}\" cy=\"{:.2f}\" r=\"{:.4g}\" fill=\"{}\"/>\n", disc.centre.x,
           disc.centre.y, disc.radius, hex(disc.colour));
  }
  void operator()(const BoxShape& box) {
    append("<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\" fill=\"{}\"/>\n",
           box.corner.x, box.corner.y, box.width, box.height, hex(box.colour));
  }
  void operator()(const TextShape& text) {
    constexpr std::string_view kAnchors[] = {"start", "middle", "end"};
    append(
        "<text x=\"{:.2f}\" y=\"{:.2f}\" font-size=\"{:.4g}\" text-anchor=\"{}\" "
        "fill=\"{}\">{}</text>\n",
        text.baseline.x, text.baseline.y, text.size,
        kAnchors[static_cast<std::size_t>(text.anchor)], hex(text.colour),
        escaped_markup(printable(text.text)));
  }
  void operator()(const PictureShape& picture) {
    append(
        "<image x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\" "
        "preserveAspectRatio=\"none\" style=\"image-rendering:pixelated\" "
        "href=\"data:image/png;base64,{}\"/>\n",
        picture.corner.x, picture.corner.y, picture.width, picture.height, png_of(picture.rgb));
  }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  template <typename... Values>
  void append(fmt::format_string<Values...> format, Values&&... values) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<Values>(values)...);
  }

  std::string text_;
};

}  // namespace

std::string to_svg(const Drawing& drawing) {
  SvgWriter writer;
  for (const DrawingShape& shape : drawing.shapes) {
    std::visit(writer, shape);
  }
  return fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" "
      "viewBox=\"0 0 {0} {1}\" font-family=\"sans-serif\">\n"
      "<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n{2}</svg>\n",
      drawing.width, drawing.height, writer.text());
}

}  // namespace vantage
