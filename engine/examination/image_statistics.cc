#include "engine/examination/image_statistics.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "engine/image/intensity_rows.h"

namespace vantage {
namespace {

constexpr double kBlackGrey = 1;
constexpr double kWhiteGrey = 254;
constexpr double kTexturelessSquaredGradient = 4;
constexpr int kWindow = 3;
constexpr int kRowsTogether = 512;  ///< so that large photographs need little memory

}  // namespace

ImageStatistics image_statistics(const Photograph& photograph, double noise_grey) {
  const int width = photograph.width();
  const int height = photograph.height();
  // The difference of two pixels has twice the variance of one.
  const double threshold = kTexturelessSquaredGradient + 2 * noise_grey * noise_grey;
  ImageStatistics result;
  for (int first = 0; first < height; first += kRowsTogether) {
    cv::Mat grey(std::min(kRowsTogether, height - first), width, CV_32F);
    for (int y = 0; y < grey.rows; ++y) {
      intensity_row(photograph, first + y, grey.ptr<float>(y));
    }
    result.mean_grey += cv::sum(grey)[0];
    result.black_share += cv::countNonZero(grey <= kBlackGrey);
    result.white_share += cv::countNonZero(grey >= kWhiteGrey);
    if (width > 1) {
      const cv::Mat gradient = grey.colRange(1, width) - grey.colRange(0, width - 1);
      cv::Mat sums;
      cv::boxFilter(gradient.mul(gradient), sums, CV_32F, {kWindow, kWindow}, {-1, -1}, false,
                    cv::BORDER_REPLICATE);
      result.textureless_share += cv::countNonZero(sums < kWindow * kWindow * threshold);
    }
  }
  const double pixels = static_cast<double>(width) * height;
  result.mean_grey /= pixels;
  result.black_share /= pixels;
  result.white_share /= pixels;
  result.textureless_share = width > 1 ? result.textureless_share / (pixels - height) : 1;
  return result;
}

}  // namespace vantage
