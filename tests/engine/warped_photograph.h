#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <opencv2/imgproc.hpp>
#include <utility>
#include <variant>

#include "engine/image/photograph.h"

namespace vantage {
inline namespace test {

/// What `homography` (pixel of the result ← pixel of the image) makes of an 8-bit image, by OpenCV;
/// `border`: what lies outside it. Of more `samples` along each direction a pixel is their mean,
/// for homographies that reduce.
inline Photograph warped(const Photograph& photograph, const Eigen::Matrix3d& homography,
                         int samples = 1, int border = cv::BORDER_REFLECT) {
  const auto& from = std::get<Image<std::uint8_t>>(photograph.pixels);
  const int type = CV_MAKETYPE(CV_8U, from.channels());
  const cv::Mat source(from.height(), from.width(), type, const_cast<std::uint8_t*>(from.row(0)),
                       from.view().stride());
  Eigen::Matrix3d finer = Eigen::Matrix3d::Identity();
  finer(0, 0) = finer(1, 1) = samples;
  finer(0, 2) = finer(1, 2) = 0.5 * (samples - 1);
  const Eigen::Matrix3d to_samples = finer * homography;
  cv::Mat matrix(3, 3, CV_64F);
  for (int i = 0; i < 9; ++i) {
    matrix.at<double>(i / 3, i % 3) = to_samples(i / 3, i % 3);
  }
  cv::Mat sampled;
  cv::warpPerspective(source, sampled, matrix, {samples * from.width(), samples * from.height()},
                      cv::INTER_CUBIC, border);
  Image<std::uint8_t> result(from.width(), from.height(), from.channels());
  cv::Mat target(from.height(), from.width(), type, result.row(0), result.view().stride());
  cv::resize(sampled, target, target.size(), 0, 0, cv::INTER_AREA);
  return {std::move(result)};
}

}  // namespace test
}  // namespace vantage
