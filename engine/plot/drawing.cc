#include "engine/plot/drawing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <string_view>
#include <utility>

#include "engine/error.h"
#include "engine/io/files/encoded_text.h"
#include "engine/io/images/png_encoder.h"

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

template <typename... Values>
void append(std::string& text, fmt::format_string<Values...> format, Values&&... values) {
  fmt::format_to(std::back_inserter(text), format, std::forward<Values>(values)...);
}

}  // namespace

void Drawing::stroke(const std::vector<DrawingPoint>& points, double line_width, Colour colour) {
  append(shapes_,
         "<polyline fill=\"none\" stroke=\"{}\" stroke-width=\"{:.4g}\" "
         "stroke-linejoin=\"round\" points=\"",
         hex(colour), line_width);
  for (const DrawingPoint& point : points) {
    append(shapes_, "{:.2f},{:.2f} ", point.x, point.y);
  }
  shapes_ += "\"/>\n";
}

void Drawing::disc(DrawingPoint centre, double radius, Colour colour) {
  append(shapes_, "<circle cx=\"{:.2f}\" cy=\"{:.2f}\" r=\"{:.4g}\" fill=\"{}\"/>\n", centre.x,
         centre.y, radius, hex(colour));
}

void Drawing::text(DrawingPoint baseline, std::string text, TextAnchor anchor, double size) {
  constexpr std::string_view kAnchors[] = {"start", "middle", "end"};
  append(shapes_,
         "<text x=\"{:.2f}\" y=\"{:.2f}\" font-size=\"{:.4g}\" text-anchor=\"{}\" "
         "fill=\"{}\">{}</text>\n",
         baseline.x, baseline.y, size, kAnchors[static_cast<std::size_t>(anchor)], hex(kInk),
         escaped_markup(printable(std::move(text))));
}

void Drawing::picture(DrawingPoint corner, double columns, double rows,
                      const Image<std::uint8_t>& rgb) {
  append(shapes_,
         "<image x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\" "
         "preserveAspectRatio=\"none\" style=\"image-rendering:pixelated\" "
         "href=\"data:image/png;base64,{}\"/>\n",
         corner.x, corner.y, columns, rows, png_of(rgb));
}

std::string Drawing::svg() const {
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" "
      "viewBox=\"0 0 {0} {1}\" font-family=\"sans-serif\">\n"
      "<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n{2}</svg>\n",
      width, height, shapes_);
}

double text_width(const std::string& text, double size) {
  constexpr double kMeanLetterWidth = 0.56;  // of common sans-serif fonts
  return kMeanLetterWidth * size * static_cast<double>(text.size());
}

}  // namespace vantage
