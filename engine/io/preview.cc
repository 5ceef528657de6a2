#include "engine/io/preview.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "engine/error.h"
#include "engine/io/opencv_setup.h"

namespace vantage {

PreviewRange choose_preview_range(ImageView<const float> disparity) {
  std::vector<float> known;
  known.reserve(static_cast<std::size_t>(disparity.width()) *
                static_cast<std::size_t>(disparity.height()));
  for (int y = 0; y < disparity.height(); ++y) {
    std::copy_if(disparity.row(y), disparity.row(y) + disparity.width(), std::back_inserter(known),
                 [](float d) { return std::isfinite(d); });
  }
  if (known.empty()) {
    return {};
  }
  const std::size_t last = known.size() - 1;
  const auto percentile = [&](std::size_t percent) {
    const auto position = known.begin() + static_cast<std::ptrdiff_t>(last * percent / 100);
    std::nth_element(known.begin(), position, known.end());
    return *position;
  };
  const float low = percentile(1);
  const float high = percentile(99);
  return low < high ? PreviewRange{low, high} : PreviewRange{low - 0.5F, high + 0.5F};
}

Image<std::uint8_t> colour_preview(ImageView<const float> disparity, float min_px, float max_px) {
  if (!(min_px < max_px) || !std::isfinite(min_px) || !std::isfinite(max_px)) {
    throw UsageError(
        fmt::format("preview range is {}..{} px, expected two finite numbers, the smaller first",
                    min_px, max_px));
  }
  prepare_opencv();
  cv::Mat levels(1, 256, CV_8UC1);
  std::iota(levels.ptr(), levels.ptr() + 256, std::uint8_t{0});
  cv::Mat colours_bgr;
  cv::applyColorMap(levels, colours_bgr, cv::COLORMAP_TURBO);

  Image<std::uint8_t> preview(disparity.width(), disparity.height(), 3);
  for (int y = 0; y < disparity.height(); ++y) {
    for (int x = 0; x < disparity.width(); ++x) {
      const float d = disparity.at(x, y);
      cv::Vec3b bgr(0, 0, 0);
      if (std::isfinite(d)) {
        const double position = (double{d} - min_px) / (double{max_px} - min_px);
        bgr = colours_bgr.at<cv::Vec3b>(
            0, static_cast<int>(std::lround(255 * std::clamp(position, 0.0, 1.0))));
      }
      for (int channel = 0; channel < 3; ++channel) {
        preview.at(x, y, channel) = bgr[2 - channel];
      }
    }
  }
  return preview;
}

}  // namespace vantage
