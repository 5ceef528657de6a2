#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "engine/io/images/opencv_setup.h"
#include "engine/plot/drawing.h"

namespace vantage {
namespace {

// OpenCV takes coordinates in sixteenths of a pixel.
constexpr int kFractionBits = 4;
constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
// Cap height of that font at scale 1, and of common fonts of size 1.
constexpr double kFontCapitalHeight = 22;
constexpr double kCapitalHeight = 0.68;

cv::Scalar rgb(Colour colour) {
  return {double(colour.red), double(colour.green), double(colour.blue)};
}

/// Paints shapes onto an RGB picture.
class RasterPainter {
 public:
  RasterPainter(cv::Mat target, double scale) : target_(std::move(target)), scale_(scale) {}

  void operator()(const StrokeShape& stroke) {
    std::vector<cv::Point> points;
    for (const DrawingPoint& point : stroke.points) {
      points.push_back(fixed_point(point));
    }
    cv::polylines(target_, points, false, rgb(stroke.colour), thickness(stroke.width), cv::LINE_AA,
                  kFractionBits);
  }
  void operator()(const PolygonShape& polygon) {
    std::vector<cv::Point> corners;
    for (const DrawingPoint& point : polygon.corners) {
      corners.push_back(fixed_point(point));
    }
    cv::fillConvexPoly(target_, corners, rgb(polygon.fill), cv::LINE_AA, kFractionBits);
    cv::polylines(target_, corners, true, rgb(polygon.outline), 1, cv::LINE_AA, kFractionBits);
  }
  void operator()(const DiscShape& disc) {
    cv::circle(target_, fixed_point(disc.centre), fixed(disc.radius), rgb(disc.colour), cv::FILLED,
               cv::LINE_AA, kFractionBits);
  }
  void operator()(const BoxShape& box) {
    cv::rectangle(target_, pixels_of(box.corner, box.width, box.height), rgb(box.colour),
                  cv::FILLED);
  }
  void operator()(const TextShape& text) {
    const double font_scale = text.size * scale_ * kCapitalHeight / kFontCapitalHeight;
    const int weight = std::max(1, static_cast<int>(std::lround(text.size * scale_ / 18)));
    int below = 0;
    const cv::Size size = cv::getTextSize(text.text, kFont, font_scale, weight, &below);
    const int shift = text.anchor == TextShape::Anchor::kBegin    ? 0
                      : text.anchor == TextShape::Anchor::kMiddle ? size.width / 2
                                                                  : size.width;
    const cv::Point origin(pixel(text.baseline.x) - shift, pixel(text.baseline.y));
    cv::putText(target_, text.text, origin, kFont, font_scale, rgb(text.colour), weight,
                cv::LINE_AA);
  }
  void operator()(const PictureShape& picture) {
    const cv::Rect wanted = pixels_of(picture.corner, picture.width, picture.height);
    const cv::Rect place = wanted & cv::Rect({0, 0}, target_.size());
    if (place.empty()) {
      return;
    }
    const Image<std::uint8_t>& image = picture.rgb;
    const cv::Mat source(image.height(), image.width(), CV_8UC3,
                         const_cast<std::uint8_t*>(image.row(0)), image.view().stride());
    cv::Mat stretched;
    cv::resize(source, stretched, wanted.size(), 0, 0, cv::INTER_NEAREST_EXACT);
    stretched(place - wanted.tl()).copyTo(target_(place));
  }

 private:
  [[nodiscard]] int pixel(double units) const {
    return static_cast<int>(std::lround(units * scale_));
  }
  [[nodiscard]] int fixed(double units) const {
    return static_cast<int>(std::lround(units * scale_ * (1 << kFractionBits)));
  }
  [[nodiscard]] cv::Point fixed_point(const DrawingPoint& point) const {
    return {fixed(point.x), fixed(point.y)};
  }
  [[nodiscard]] int thickness(double width) const { return std::max(1, pixel(width)); }
  [[nodiscard]] cv::Rect pixels_of(const DrawingPoint& corner, double width, double height) const {
    const int x = pixel(corner.x);
    const int y = pixel(corner.y);
    return {x, y, std::max(1, pixel(corner.x + width) - x),
            std::max(1, pixel(corner.y + height) - y)};
  }

  cv::Mat target_;
  double scale_;
};

}  // namespace

Image<std::uint8_t> rasterize(const Drawing& drawing, int pixels_per_unit) {
  prepare_opencv();
  Image<std::uint8_t> image(drawing.width * pixels_per_unit, drawing.height * pixels_per_unit, 3);
  image.fill(255);
  RasterPainter painter(
      cv::Mat(image.height(), image.width(), CV_8UC3, image.row(0), image.view().stride()),
      pixels_per_unit);
  for (const DrawingShape& shape : drawing.shapes) {
    std::visit(painter, shape);
  }
  return image;
}

}  // namespace vantage
