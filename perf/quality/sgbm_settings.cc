#include "perf/quality/sgbm_settings.h"

#include <fmt/format.h>

#include <string_view>

#include "engine/refinement/refine_maps.h"

namespace vantage::perf {

std::string to_text(const SgbmPostProcessing& post) {
  return fmt::format("uniqueness {}, speckles {}/{}, our speckles {}", post.uniqueness_percent,
                     post.opencv_speckle_px, post.opencv_speckle_range_px, post.speckle_size_px);
}

const std::vector<SgbmSetting>& sgbm_settings() {
  // Found by search_sgbm_post_processing() on all scenes of true_scenes() except aloe_full.
  static const std::vector<SgbmSetting> settings = {
      {"sgbm-3", cv::StereoSGBM::MODE_SGBM, 3, {0, 100, 1, 0}},
      {"sgbm-5", cv::StereoSGBM::MODE_SGBM, 5, {0, 0, 0, 100}},
      {"3way-3", cv::StereoSGBM::MODE_SGBM_3WAY, 3, {0, 100, 1, 0}},
      {"3way-5", cv::StereoSGBM::MODE_SGBM_3WAY, 5, {0, 100, 1, 0}},
      {"hh-3", cv::StereoSGBM::MODE_HH, 3, {10, 100, 1, 0}},
      {"hh-5", cv::StereoSGBM::MODE_HH, 5, {10, 100, 1, 0}},
  };
  return settings;
}

cv::Ptr<cv::StereoSGBM> make_sgbm_matcher(const SgbmSetting& setting, const ScenePair& pair) {
  cv::Ptr<cv::StereoSGBM> matcher =
      make_sgbm(pair.range, setting.block_px, pair.left_opencv.channels(), setting.mode);
  matcher->setUniquenessRatio(setting.post_processing.uniqueness_percent);
  matcher->setSpeckleWindowSize(0);
  return matcher;
}

void filter_opencv_speckles(const SgbmPostProcessing& post, DisparityRange range,
                            cv::Mat& disparities) {
  constexpr int kUnitsPerPixel = cv::StereoMatcher::DISP_SCALE;
  if (post.opencv_speckle_px == 0) {
    return;
  }
  cv::filterSpeckles(disparities, (range.min - 1) * kUnitsPerPixel, post.opencv_speckle_px,
                     post.opencv_speckle_range_px * kUnitsPerPixel);
}

void refine_peer_maps(const SgbmPostProcessing& post, const ScenePair& pair,
                      const PeerDisparities& disparities, Execution& execution,
                      DisparityMaps& refined) {
  refined.left.disparity_px = to_map(disparities.left, pair.range.min);
  refined.right.disparity_px = to_map(disparities.right, pair.range.min);
  RefinementOptions options;
  options.speckle_size_px = post.speckle_size_px;
  options.fill = Fill::kMedian;
  RefinementWork work;
  const MapToRefine left{.side = Side::kLeft, .image = &pair.left, .map = &refined.left};
  const MapToRefine right{.side = Side::kRight, .image = &pair.right, .map = &refined.right};
  refine_maps(options, left, &right, execution, work, [](std::string_view) {});
}

}  // namespace vantage::perf
