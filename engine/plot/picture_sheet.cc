#include "engine/plot/picture_sheet.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/plot/axis.h"

namespace vantage {
namespace {

constexpr double kSheetMargin = 16;
constexpr double kPictureGap = 10;
constexpr double kTitleLine = kTextSize + 3;

std::vector<std::string> lines_within(const std::string& text, double width) {
  std::vector<std::string> lines(1);
  std::size_t begin = 0;
  while (begin < text.size()) {
    const std::size_t end = std::min(text.find(' ', begin), text.size());
    const std::string word = text.substr(begin, end - begin);
    if (!lines.back().empty() && text_width(lines.back() + ' ' + word, kTextSize) > width) {
      lines.emplace_back();
    }
    lines.back() += (lines.back().empty() ? "" : " ") + word;
    begin = end + 1;
  }
  return lines;
}

Image<std::uint8_t> in_rgb(const Image<std::uint8_t>& pixels) {
  Image<std::uint8_t> rgb(pixels.width(), pixels.height(), 3);
  for (int y = 0; y < rgb.height(); ++y) {
    for (int x = 0; x < rgb.width(); ++x) {
      for (int c = 0; c < 3; ++c) {
        rgb.at(x, y, c) = pixels.at(x, y, pixels.channels() == 1 ? 0 : c);
      }
    }
  }
  return rgb;
}

}  // namespace

Drawing draw_picture_sheet(const std::string& title, const std::vector<SheetPicture>& pictures,
                           int columns, double width) {
  const auto used_columns = static_cast<std::size_t>(
      std::clamp(columns, 1, std::max(1, static_cast<int>(pictures.size()))));
  Drawing drawing;
  drawing.width = static_cast<int>(
      std::max(2 * kSheetMargin + static_cast<double>(used_columns) * (width + kPictureGap),
               2 * kSheetMargin + text_width(title, kTextSize + 5)));
  draw_page_title(title, drawing);
  double top = kPageTitleHeight + kPictureGap;
  for (std::size_t first = 0; first < pictures.size(); first += used_columns) {
    const std::size_t end = std::min(first + used_columns, pictures.size());
    std::size_t title_lines = 0;
    double height = 0;
    for (std::size_t i = first; i < end; ++i) {
      title_lines = std::max(title_lines, lines_within(pictures[i].title, width).size());
      height = std::max(height, width * pictures[i].pixels.height() / pictures[i].pixels.width());
    }
    top += static_cast<double>(title_lines) * kTitleLine;
    for (std::size_t i = first; i < end; ++i) {
      const double x = kSheetMargin + static_cast<double>(i - first) * (width + kPictureGap);
      const auto lines = lines_within(pictures[i].title, width);
      double baseline = top - 4 - static_cast<double>(lines.size() - 1) * kTitleLine;
      for (const std::string& line : lines) {
        drawing.text({x, baseline}, line);
        baseline += kTitleLine;
      }
      drawing.picture({x, top}, width,
                      width * pictures[i].pixels.height() / pictures[i].pixels.width(),
                      in_rgb(pictures[i].pixels));
    }
    top += height + kPictureGap;
  }
  drawing.height = static_cast<int>(std::ceil(top));
  return drawing;
}

Image<std::uint8_t> grey_picture(ImageView<const float> values, float min, float max,
                                 Colour unknown) {
  Image<std::uint8_t> picture(values.width(), values.height(), 3);
  const std::array<std::uint8_t, 3> colour = {unknown.red, unknown.green, unknown.blue};
  for (int y = 0; y < values.height(); ++y) {
    for (int x = 0; x < values.width(); ++x) {
      const float value = values.at(x, y);
      const float level = 255 * std::clamp((value - min) / (max - min), 0.0F, 1.0F);
      for (int c = 0; c < 3; ++c) {
        picture.at(x, y, c) = std::isfinite(value) ? static_cast<std::uint8_t>(std::lround(level))
                                                   : colour[static_cast<std::size_t>(c)];
      }
    }
  }
  return picture;
}

}  // namespace vantage
