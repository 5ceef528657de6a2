#include "engine/rectification/image_features.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>
#include <utility>

#include "engine/image/intensity_rows.h"
#include "engine/io/images/opencv_setup.h"
#include "engine/late_library.h"
#include "scheduler/interruption.h"

namespace vantage {

/// A photograph prepared for feature detection.
struct FeatureImage {
  cv::Mat levels;     ///< 8-bit grey, stretched to its range
  cv::Mat contrast;   ///< 8-bit: difference from the local mean
  cv::Point2d scale;  ///< pixels of the photograph per pixel of `levels`
};

/// Positions in `levels`, and a row of `descriptors` for each.
struct DetectedFeatures {
  std::vector<cv::KeyPoint> points;
  cv::Mat descriptors;
};

namespace {

// Cells per image side; each cell may keep its share of the features.
constexpr int kCellsAlongSide = 12;
// The nearest descriptor must be closer than this fraction of the second nearest distance.
constexpr float kRatio = 0.7F;
constexpr int kRefinementWindow_px = 15;
constexpr float kMaxRefinement_px = 2;

/// cv::calcOpticalFlowPyrLK(). Its library, which loads neural networks too, is opened by the first
/// call. Throws Error when it cannot be opened.
decltype(&cv::calcOpticalFlowPyrLK) optical_flow() {
  static const LateLibrary library(VANTAGE_TRACKING_LIBRARY,
                                   "cannot refine points that images share");
  // Itanium C++ ABI name of the function declared with the type above.
  static const auto function = library.function<decltype(&cv::calcOpticalFlowPyrLK)>(
      "_ZN2cv20calcOpticalFlowPyrLKERKNS_11_InputArrayES2_S2_RKNS_17_InputOutputArrayERKNS_12_"
      "OutputArrayES8_NS_5Size_IiEEiNS_12TermCriteriaEid");
  return function;
}

cv::Mat grey_image(const Photograph& photograph) {
  cv::Mat grey(photograph.height(), photograph.width(), CV_32F);
  for (int y = 0; y < grey.rows; ++y) {
    intensity_row(photograph, y, grey.ptr<float>(y));
  }
  return grey;
}

/// Stretched so that all but a thousandth of the levels at each end span 0 to 255.
cv::Mat stretched(const cv::Mat& grey) {
  constexpr double kTail = 1e-3;
  std::vector<float> sample;
  const std::size_t step = std::max<std::size_t>(grey.total() / 20000, 1);
  for (std::size_t i = 0; i < grey.total(); i += step) {
    sample.push_back(grey.at<float>(static_cast<int>(i / static_cast<std::size_t>(grey.cols)),
                                    static_cast<int>(i % static_cast<std::size_t>(grey.cols))));
  }
  const auto tail = static_cast<std::size_t>(kTail * static_cast<double>(sample.size()));
  const auto sorted_at = [&](std::size_t place) {
    const auto at = sample.begin() + static_cast<std::ptrdiff_t>(place);
    std::nth_element(sample.begin(), at, sample.end());
    return *at;
  };
  const double min = sorted_at(tail);
  const double range = std::max<double>(sorted_at(sample.size() - 1 - tail) - min, 1e-3);
  cv::Mat levels;
  grey.convertTo(levels, CV_8U, 255 / range, -min * 255 / range);
  return levels;
}

cv::Mat local_contrast(const cv::Mat& levels) {
  constexpr int kSurroundings_px = 21;
  constexpr double kFlat = 16;  // variance below which there is no structure, in grey levels
                                // squared
  const cv::Size window(kSurroundings_px, kSurroundings_px);
  cv::Mat mean;
  cv::Mat mean_of_squares;
  cv::boxFilter(levels, mean, CV_32F, window);
  cv::sqrBoxFilter(levels, mean_of_squares, CV_32F, window);
  cv::Mat deviation = mean_of_squares - mean.mul(mean) + kFlat;
  cv::sqrt(deviation, deviation);
  cv::Mat difference;
  cv::subtract(levels, mean, difference, cv::noArray(), CV_32F);
  cv::divide(difference, deviation, difference);
  cv::Mat contrast;
  difference.convertTo(contrast, CV_8U, 45, 128);
  return contrast;
}

FeatureImage search_image(const Photograph& photograph, int largest_side_px) {
  FeatureImage image;
  cv::Mat grey = grey_image(photograph);
  const double reduction = static_cast<double>(largest_side_px) / std::max(grey.cols, grey.rows);
  if (reduction < 1) {
    const cv::Size size(std::max(static_cast<int>(std::lround(grey.cols * reduction)), 1),
                        std::max(static_cast<int>(std::lround(grey.rows * reduction)), 1));
    cv::Mat reduced;
    cv::resize(grey, reduced, size, 0, 0, cv::INTER_AREA);
    grey = reduced;
  }
  image.scale = {static_cast<double>(photograph.width()) / grey.cols,
                 static_cast<double>(photograph.height()) / grey.rows};
  image.levels = stretched(grey);
  image.contrast = local_contrast(image.levels);
  return image;
}

Eigen::Vector2d in_photograph(const FeatureImage& image, const cv::Point2f& point) {
  return {(point.x + 0.5) * image.scale.x - 0.5, (point.y + 0.5) * image.scale.y - 0.5};
}

/// The strongest features of every cell, reordered.
std::vector<cv::KeyPoint> spread(std::vector<cv::KeyPoint> points, const cv::Size& size, int max) {
  const auto cell_of = [&](const cv::KeyPoint& point) {
    const auto along = [](float position, int side_px) {
      return std::clamp(static_cast<int>(position) * kCellsAlongSide / side_px, 0,
                        kCellsAlongSide - 1);
    };
    return along(point.pt.y, size.height) * kCellsAlongSide + along(point.pt.x, size.width);
  };
  std::stable_sort(points.begin(), points.end(), [&](const auto& a, const auto& b) {
    const std::array<float, 5> first = {-a.response, a.pt.y, a.pt.x, a.size, a.angle};
    const std::array<float, 5> second = {-b.response, b.pt.y, b.pt.x, b.size, b.angle};
    return first < second;
  });
  // Empty cells leave their share to others, up to twice a share.
  const int share = std::max(2 * max / (kCellsAlongSide * kCellsAlongSide), 1);
  std::array<int, kCellsAlongSide * kCellsAlongSide> kept_of_cell{};
  std::vector<cv::KeyPoint> kept;
  for (const cv::KeyPoint& point : points) {
    int& count = kept_of_cell[static_cast<std::size_t>(cell_of(point))];
    if (count < share && static_cast<int>(kept.size()) < max) {
      ++count;
      kept.push_back(point);
    }
  }
  return kept;
}

DetectedFeatures features_of(const FeatureImage& image, const FeatureMatchOptions& options) {
  constexpr double kSiftContrast = 0.02;
  constexpr int kFastThreshold = 12;
  const cv::Ptr<cv::Feature2D> detector =
      options.kind == FeatureKind::kSift
          ? cv::Ptr<cv::Feature2D>(cv::SIFT::create(0, 3, kSiftContrast))
          : cv::Ptr<cv::Feature2D>(cv::ORB::create(3 * options.max_features, 1.4F, 3, 15, 0, 2,
                                                   cv::ORB::FAST_SCORE, 31, kFastThreshold));
  DetectedFeatures features;
  scheduler::check_interruption();
  detector->detect(image.levels, features.points);
  scheduler::check_interruption();
  features.points = spread(std::move(features.points), image.levels.size(), options.max_features);
  if (!features.points.empty()) {
    detector->compute(image.levels, features.points, features.descriptors);
  }
  return features;
}

}  // namespace

struct ImageFeatures::Content {
  FeatureKind kind = FeatureKind::kSift;
  FeatureImage image;
  DetectedFeatures features;
};

ImageFeatures::ImageFeatures(const Photograph& photograph, const FeatureMatchOptions& options) {
  options.validate();
  prepare_opencv();
  auto content = std::make_unique<Content>();
  content->kind = options.kind;
  content->image = search_image(photograph, options.largest_side_px);
  content->features = features_of(content->image, options);
  content_ = std::move(content);
}

ImageFeatures::~ImageFeatures() = default;
ImageFeatures::ImageFeatures(ImageFeatures&&) noexcept = default;

int ImageFeatures::count() const { return static_cast<int>(content_->features.points.size()); }

Eigen::Vector2d ImageFeatures::position_px(int feature) const {
  return in_photograph(content_->image,
                       content_->features.points.at(static_cast<std::size_t>(feature)).pt);
}

std::vector<std::array<int, 2>> mutual_features(const ImageFeatures& left,
                                                const ImageFeatures& right, int strongest) {
  const DetectedFeatures& first = left.content().features;
  const DetectedFeatures& second = right.content().features;
  if (first.points.empty() || second.points.size() < 2) {
    return {};
  }
  const cv::BFMatcher matcher(left.content().kind == FeatureKind::kSift ? cv::NORM_L2
                                                                        : cv::NORM_HAMMING);
  std::vector<std::vector<cv::DMatch>> nearest;
  const auto rows_of = [&](const cv::Mat& descriptors) {
    return descriptors.rowRange(0, std::min(descriptors.rows, strongest));
  };
  const cv::Mat first_rows = rows_of(first.descriptors);
  const cv::Mat second_rows = rows_of(second.descriptors);
  scheduler::check_interruption();
  matcher.knnMatch(first_rows, second_rows, nearest, 2);
  scheduler::check_interruption();
  std::vector<cv::DMatch> back;
  matcher.match(second_rows, first_rows, back);
  std::vector<std::array<int, 2>> mutual;
  for (const std::vector<cv::DMatch>& candidates : nearest) {
    if (candidates.size() == 2 && candidates[0].distance < kRatio * candidates[1].distance &&
        back[static_cast<std::size_t>(candidates[0].trainIdx)].trainIdx == candidates[0].queryIdx) {
      mutual.push_back({candidates[0].queryIdx, candidates[0].trainIdx});
    }
  }
  return mutual;
}

std::vector<std::optional<Eigen::Vector2d>> refined_partners(
    const ImageFeatures& left, const ImageFeatures& right,
    std::span<const std::array<int, 2>> pairs) {
  if (pairs.empty()) {
    return {};
  }
  std::vector<cv::Point2f> left_points;
  std::vector<cv::Point2f> right_points;
  for (const auto& [first, second] : pairs) {
    left_points.push_back(left.content().features.points[static_cast<std::size_t>(first)].pt);
    right_points.push_back(right.content().features.points[static_cast<std::size_t>(second)].pt);
  }
  std::vector<cv::Point2f> refined = right_points;
  std::vector<std::uint8_t> found;
  std::vector<float> unused_errors;
  constexpr double kMinEigenvalue = 1e-4;  // OpenCV's default
  scheduler::check_interruption();
  optical_flow()(left.content().image.contrast, right.content().image.contrast, left_points,
                 refined, found, unused_errors,
                 cv::Size(kRefinementWindow_px, kRefinementWindow_px), 0,
                 cv::TermCriteria(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 30, 1e-3),
                 cv::OPTFLOW_USE_INITIAL_FLOW, kMinEigenvalue);
  std::vector<std::optional<Eigen::Vector2d>> partners;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const cv::Point2f step = refined[i] - right_points[i];
    const bool is_refined =
        found[i] != 0 && std::max(std::abs(step.x), std::abs(step.y)) <= kMaxRefinement_px;
    partners.push_back(is_refined ? std::optional(in_photograph(right.content().image, refined[i]))
                                  : std::nullopt);
  }
  return partners;
}

}  // namespace vantage
