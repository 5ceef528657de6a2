#pragma once

#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cstring>
#include <limits>

#include "engine/image/image.h"
#include "engine/image/photograph.h"
#include "engine/matching/options/match_options.h"

namespace vantage::perf {

/// The photograph in OpenCV's format: BGR or grey, 8 bits. Throws std::bad_variant_access if it
/// does not have 8 bits.
inline cv::Mat to_opencv(const Photograph& photograph) {
  const auto& image = std::get<Image<std::uint8_t>>(photograph.pixels);
  cv::Mat mat(image.height(), image.width(), CV_8UC(image.channels()));
  for (int y = 0; y < image.height(); ++y) {
    std::memcpy(mat.ptr(y), image.row(y), mat.cols * mat.elemSize());
  }
  if (image.channels() == 3) {
    cv::cvtColor(mat, mat, cv::COLOR_RGB2BGR);
  }
  return mat;
}

/// 8-bit grey, converted by OpenCV.
inline Photograph to_grey(const Photograph& photograph) {
  cv::Mat mat = to_opencv(photograph);
  if (mat.channels() == 3) {
    cv::cvtColor(mat, mat, cv::COLOR_BGR2GRAY);
  }
  Image<std::uint8_t> image(mat.cols, mat.rows);
  for (int y = 0; y < mat.rows; ++y) {
    std::memcpy(image.row(y), mat.ptr(y), static_cast<std::size_t>(mat.cols));
  }
  return {std::move(image)};
}

/// OpenCV's matchers require a multiple of 16 candidates.
inline int opencv_candidates(DisparityRange range) { return (range.count() + 15) / 16 * 16; }

inline cv::Ptr<cv::StereoBM> make_bm(DisparityRange range, int window_px) {
  cv::Ptr<cv::StereoBM> bm = cv::StereoBM::create(opencv_candidates(range), window_px);
  bm->setMinDisparity(range.min);
  return bm;
}

/// Parameters recommended by OpenCV's documentation and samples.
inline cv::Ptr<cv::StereoSGBM> make_sgbm(DisparityRange range, int block, int channels, int mode) {
  return cv::StereoSGBM::create(range.min, opencv_candidates(range), block,
                                8 * channels * block * block, 32 * channels * block * block, 1, 63,
                                10, 100, 32, mode);
}

/// Converts OpenCV's 16ths of pixels to a disparity map; values it marks as invalid become NaN.
inline DisparityMap to_map(const cv::Mat& sixteenths, int min_disparity) {
  DisparityMap map(sixteenths.cols, sixteenths.rows);
  for (int y = 0; y < sixteenths.rows; ++y) {
    for (int x = 0; x < sixteenths.cols; ++x) {
      const float value = static_cast<float>(sixteenths.at<short>(y, x)) / 16.0F;
      map.at(x, y) = value < static_cast<float>(min_disparity)
                         ? std::numeric_limits<float>::quiet_NaN()
                         : value;
    }
  }
  return map;
}

/// A matcher's left map in 16ths of pixels. The images are padded by the search range, because the
/// matcher omits columns that lack a candidate.
inline cv::Mat left_disparities(cv::StereoMatcher& matcher, const cv::Mat& left,
                                const cv::Mat& right, DisparityRange range) {
  const int pad_left = std::max(0, range.min + opencv_candidates(range));
  const int pad_right = std::max(0, -range.min);
  cv::Mat padded_left;
  cv::Mat padded_right;
  cv::Mat disparity;
  cv::copyMakeBorder(left, padded_left, 0, 0, pad_left, pad_right, cv::BORDER_REPLICATE);
  cv::copyMakeBorder(right, padded_right, 0, 0, pad_left, pad_right, cv::BORDER_REPLICATE);
  matcher.compute(padded_left, padded_right, disparity);
  return {disparity.colRange(pad_left, pad_left + left.cols)};
}

/// Same for both images; the right map is computed from the mirrored, exchanged images.
struct PeerDisparities {
  cv::Mat left;
  cv::Mat right;
};

inline PeerDisparities both_disparities(cv::StereoMatcher& matcher, const cv::Mat& left,
                                        const cv::Mat& right, DisparityRange range) {
  cv::Mat left_flipped;
  cv::Mat right_flipped;
  cv::flip(left, left_flipped, 1);
  cv::flip(right, right_flipped, 1);
  PeerDisparities disparities;
  disparities.left = left_disparities(matcher, left, right, range);
  cv::flip(left_disparities(matcher, right_flipped, left_flipped, range), disparities.right, 1);
  return disparities;
}

/// See PeerDisparities; invalid values are NaN.
struct PeerMaps {
  DisparityMap left;
  DisparityMap right;
};

inline PeerMaps sgbm_maps(const cv::Mat& left, const cv::Mat& right, DisparityRange range,
                          int block, int mode) {
  const PeerDisparities disparities =
      both_disparities(*make_sgbm(range, block, left.channels(), mode), left, right, range);
  return {to_map(disparities.left, range.min), to_map(disparities.right, range.min)};
}

}  // namespace vantage::perf
