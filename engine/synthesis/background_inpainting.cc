#include "engine/synthesis/background_inpainting.h"

#include <algorithm>
#include <limits>
#include <opencv2/core.hpp>
#include <opencv2/photo.hpp>
#include <type_traits>

#include "kernels/pixel_row/pixel_row.h"

namespace vantage {
namespace {

constexpr int kRadiusPx = 5;
constexpr int kReachPx = kRadiusPx + 1;  // the method uses differences of neighbours
constexpr int kWidestRunPx = 64;         // beyond it, marking would take longer than inpainting

// Marks pixels nearer than the run [begin, end) of row y, which is to be inpainted, that could
// contribute to it. The method works inwards from all sides at one speed: pixels farther away than
// the background plus the reach do not contribute.
void mark_around(int y, int begin, int end, ImageView<const float> disparity_px, float limit,
                 cv::Mat& avoided) {
  const float nearest = disparity_px.at(begin, y) + limit;  // NaN: all is background
  const int width = disparity_px.width();
  const bool left_is_background = begin > 0 && disparity_px.at(begin - 1, y) <= nearest;
  const bool right_is_background = end < width && disparity_px.at(end, y) <= nearest;
  const int far_px = std::min(end - begin, kWidestRunPx) + kReachPx;
  const int first = std::max(begin - (left_is_background ? kReachPx : far_px), 0);
  const int last = std::min(end - 1 + (right_is_background ? kReachPx : far_px), width - 1);
  const int bottom = std::min(y + far_px, disparity_px.height() - 1);
  for (int row = std::max(y - far_px, 0); row <= bottom; ++row) {
    auto* marks = avoided.ptr<std::uint8_t>(row);
    const float* disparity = disparity_px.row(row);
    for (int x = first; x <= last; ++x) {
      marks[x] = static_cast<std::uint8_t>(disparity[x] > nearest ? 255 : marks[x]);
    }
  }
}

// `avoided`: wanted pixels and the foreground around them, 255.
void mark_avoided(ImageView<const std::uint8_t> wanted, ImageView<const float> disparity_px,
                  float limit, cv::Mat& avoided) {
  const int width = wanted.width();
  for (int y = 0; y < wanted.height(); ++y) {
    std::copy_n(wanted.row(y), width, avoided.ptr(y));
  }
  for (int y = 0; y < wanted.height(); ++y) {
    for (int begin = 0; begin < width; ++begin) {
      int end = begin;
      while (end < width && wanted.at(end, y) != 0) {
        ++end;
      }
      if (end > begin) {
        mark_around(y, begin, end, disparity_px, limit, avoided);
      }
      begin = end;
    }
  }
}

}  // namespace

std::size_t inpainting_bytes(int width, int height, int channels) {
  // Mask, planes before and after, and OpenCV's data per pixel: distances, states and queues.
  const auto pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  return pixels * (1 + 2 * sizeof(float) * static_cast<std::size_t>(channels == 1 ? 1 : 3) + 32);
}

template <typename T>
void inpaint_background(ImageView<T> image, ImageView<const std::uint8_t> wanted,
                        ImageView<const float> disparity_px, double gradient_limit_px) {
  const int width = image.width();
  const int height = image.height();
  cv::Mat avoided(height, width, CV_8UC1);
  mark_avoided(wanted, disparity_px, static_cast<float>(gradient_limit_px), avoided);
  const int avoided_pixels = cv::countNonZero(avoided);
  if (avoided_pixels == 0 || avoided_pixels == width * height) {
    return;
  }
  const cv::Mat pixels(height, width, CV_MAKETYPE(cv::DataType<T>::depth, image.channels()),
                       image.data(), image.stride() * sizeof(T));
  // The method adds up to two units to its result, plus ½ for rounding except for floats.
  constexpr bool kIsFloat = std::is_floating_point_v<T>;
  constexpr double kUnit = kIsFloat ? 1 / 255.0 : 1;
  constexpr double kBias = kIsFloat ? 0.5 : 0;
  cv::Mat plane;
  cv::Mat painted;
  for (int channel = 0; channel < image.channels(); ++channel) {
    cv::extractChannel(pixels, plane, channel);
    double min = 0;
    double largest = double{kernels::kLargestValue<T>};
    if constexpr (kIsFloat) {
      double max = 0;
      cv::minMaxLoc(plane, &min, &max);
      min = std::min(min, 0.0);
      largest = std::max(largest, max);
      plane *= 1 / kUnit;
    }
    cv::inpaint(plane, avoided, painted, kRadiusPx, cv::INPAINT_TELEA);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        if (wanted.at(x, y) != 0) {
          const double value = (static_cast<double>(painted.at<T>(y, x)) - kBias) * kUnit;
          image.at(x, y, channel) = static_cast<T>(std::clamp(value, min, largest));
        }
      }
    }
  }
}

template void inpaint_background<std::uint8_t>(ImageView<std::uint8_t>,
                                               ImageView<const std::uint8_t>,
                                               ImageView<const float>, double);
template void inpaint_background<std::uint16_t>(ImageView<std::uint16_t>,
                                                ImageView<const std::uint8_t>,
                                                ImageView<const float>, double);
template void inpaint_background<float>(ImageView<float>, ImageView<const std::uint8_t>,
                                        ImageView<const float>, double);

}  // namespace vantage
