#pragma once

#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include <cmath>
#include <filesystem>
#include <limits>

#include "perf/peers.h"

namespace vantage::perf {

/// A typical OpenCV user's loop over pairs: StereoSGBM three-way for both images, a cross-check,
/// and a new view halfway between the cameras by one remap of the left image along half its
/// disparities. Maps are written as PFM, the cheapest format there; the view as PNG.
class OpenCvLoop {
 public:
  explicit OpenCvLoop(DisparityRange range)
      : range_(range), matcher_(make_sgbm(range, 5, 1, cv::StereoSGBM::MODE_SGBM_3WAY)) {}

  /// `stem` has no extension; its folder must exist.
  void work(const cv::Mat& left, const cv::Mat& right, const std::filesystem::path& folder,
            const std::string& stem) {
    matcher_->compute(left, right, left_sixteenths_);
    cv::flip(left, left_flipped_, 1);
    cv::flip(right, right_flipped_, 1);
    matcher_->compute(right_flipped_, left_flipped_, flipped_sixteenths_);
    cv::flip(flipped_sixteenths_, right_sixteenths_, 1);
    cross_check();
    cv::remap(left, view_, column_, row_, cv::INTER_CUBIC, cv::BORDER_REPLICATE);
    cv::imwrite((folder / "disparity" / (stem + ".pfm")).string(), left_map_);
    cv::imwrite((folder / "right-disparity" / (stem + ".pfm")).string(), right_map_);
    cv::imwrite((folder / "views" / (stem + ".png")).string(), view_);
  }

 private:
  /// Computes both maps in pixels, infinite where they differ by more than a pixel, and the lookup
  /// position of each pixel of the view.
  void cross_check() {
    constexpr float kUnknown = std::numeric_limits<float>::infinity();
    const cv::Size size = left_sixteenths_.size();
    left_map_.create(size, CV_32F);
    right_map_.create(size, CV_32F);
    column_.create(size, CV_32F);
    row_.create(size, CV_32F);
    const int invalid = (range_.min - 1) * 16;
    const auto check = [&](const short* own, const short* other, int direction, float* result) {
      for (int x = 0; x < size.width; ++x) {
        const int partner = x + direction * ((own[x] + 8) >> 4);
        const bool agrees = own[x] > invalid && partner >= 0 && partner < size.width &&
                            std::abs(own[x] - other[partner]) <= 16;
        result[x] = agrees ? static_cast<float>(own[x]) / 16 : kUnknown;
      }
    };
    for (int y = 0; y < size.height; ++y) {
      const auto* left = left_sixteenths_.ptr<short>(y);
      const auto* right = right_sixteenths_.ptr<short>(y);
      check(left, right, -1, left_map_.ptr<float>(y));
      check(right, left, +1, right_map_.ptr<float>(y));
      const auto* map = left_map_.ptr<float>(y);
      float last = 0;
      for (int x = 0; x < size.width; ++x) {
        last = map[x] < kUnknown ? map[x] : last;
        column_.at<float>(y, x) = static_cast<float>(x) + 0.5F * last;
        row_.at<float>(y, x) = static_cast<float>(y);
      }
    }
  }

  DisparityRange range_;
  cv::Ptr<cv::StereoSGBM> matcher_;
  cv::Mat left_flipped_, right_flipped_;
  cv::Mat left_sixteenths_, flipped_sixteenths_, right_sixteenths_;
  cv::Mat left_map_, right_map_, column_, row_, view_;
};

}  // namespace vantage::perf
