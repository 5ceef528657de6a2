#pragma once

#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include <filesystem>
#include <string>

#include "perf/peers.h"

namespace vantage::perf {

/// The least that a user of OpenCV does with a pair: one map of StereoSGBM three-way, not checked,
/// as 16-bit PNG in 1/16 px. Neither a right map nor a view.
class OpenCvLoop {
 public:
  explicit OpenCvLoop(DisparityRange range)
      : matcher_(make_sgbm(range, 5, 1, cv::StereoSGBM::MODE_SGBM_3WAY)) {}

  /// `stem` has no extension; its folder must exist.
  void work(const cv::Mat& left, const cv::Mat& right, const std::filesystem::path& folder,
            const std::string& stem) {
    matcher_->compute(left, right, sixteenths_);
    // PNG has no negative values: what is unmatched becomes 0.
    sixteenths_.convertTo(map_, CV_16U);
    cv::imwrite((folder / (stem + ".png")).string(), map_);
  }

 private:
  cv::Ptr<cv::StereoSGBM> matcher_;
  cv::Mat sixteenths_;
  cv::Mat map_;
};

}  // namespace vantage::perf
