#include "engine/io/images/black_border.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "engine/image/intensity_rows.h"

namespace vantage {
namespace {

// Grey levels. Codecs and converters leave some noise in bars.
constexpr double kBlackLevel = 12;
constexpr double kMaxNoise = 1;  // standard deviation; a sky at night has more
constexpr double kBrightLevel = 24;

constexpr double kMinShare = 0.002;  // of the picture
constexpr double kMaxShare = 0.3;
constexpr double kStraightPx = 2;  // an outline may differ so much from one of few corners
constexpr std::size_t kMaxCorners = 20;
constexpr int kSoftPx = 4;            // an edge is no wider
constexpr double kBrightShare = 0.5;  // of what is beyond it

cv::Mat mat_of(const Image<std::uint8_t>& image) {
  return {image.height(), image.width(), CV_8UC1, const_cast<std::uint8_t*>(image.row(0)),
          image.view().stride()};
}

/// 255 for all black pixels that are connected to the border.
cv::Mat black_from_border(const cv::Mat& levels) {
  cv::Mat black;
  cv::copyMakeBorder(levels <= kBlackLevel, black, 1, 1, 1, 1, cv::BORDER_CONSTANT, 255);
  constexpr double kReached = 128;
  cv::floodFill(black, {0, 0}, kReached);
  return black({1, 1, levels.cols, levels.rows}) == kReached;
}

}  // namespace

void take_brightest(const Photograph& photograph, Image<std::uint8_t>& brightest) {
  if (brightest.width() != photograph.width() || brightest.height() != photograph.height()) {
    brightest.resize(photograph.width(), photograph.height());
    brightest.fill(0);
  }
  std::vector<float> grey(static_cast<std::size_t>(photograph.width()));
  for (int y = 0; y < photograph.height(); ++y) {
    intensity_row(photograph, y, grey.data());
    std::transform(grey.begin(), grey.end(), brightest.row(y), brightest.row(y),
                   [](float level, std::uint8_t other) {
                     return std::max(other, static_cast<std::uint8_t>(level + 0.5F));
                   });
  }
}

Mask black_border(const Image<std::uint8_t>& brightest) {
  if (brightest.empty()) {
    return {};
  }
  const cv::Mat levels = mat_of(brightest);
  const cv::Mat border = black_from_border(levels);
  const double share = cv::countNonZero(border) / static_cast<double>(border.total());
  cv::Scalar mean;
  cv::Scalar noise;
  cv::meanStdDev(levels, mean, noise, border);
  if (share < kMinShare || share > kMaxShare || noise[0] > kMaxNoise) {
    return {};
  }
  std::vector<std::vector<cv::Point>> outlines;
  cv::findContours(~border, outlines, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_NONE);
  std::size_t corners = 0;
  for (const std::vector<cv::Point>& outline : outlines) {
    std::vector<cv::Point> straight;
    cv::approxPolyDP(outline, straight, kStraightPx, true);
    corners += straight.size();
  }
  constexpr int kSide = 2 * kSoftPx + 1;
  cv::Mat beyond;
  cv::dilate(border, beyond, cv::Mat::ones(kSide, kSide, CV_8U));
  beyond -= border;
  const int bright = cv::countNonZero(beyond & (levels >= kBrightLevel));
  if (corners > kMaxCorners || bright < kBrightShare * cv::countNonZero(beyond)) {
    return {};
  }
  Mask mask(brightest.width(), brightest.height());
  border.copyTo(mat_of(mask));
  return mask;
}

Mask black_border(const Photograph& photograph) {
  Image<std::uint8_t> levels;
  take_brightest(photograph, levels);
  return black_border(levels);
}

}  // namespace vantage
