#include "engine/io/images/preview.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "engine/error.h"
#include "engine/image/finite_values.h"
#include "engine/io/images/opencv_setup.h"
#include "engine/order_statistics.h"

namespace vantage {

PreviewRange choose_preview_range(ImageView<const float> disparity) {
  std::vector<float> known = finite_values(disparity);
  if (known.empty()) {
    return {};
  }
  const std::size_t last = known.size() - 1;
  const float low = value_of_rank(known, last / 100);
  const float high = value_of_rank(known, last * 99 / 100);
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
