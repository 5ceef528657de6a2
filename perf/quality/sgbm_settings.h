#pragma once

#include <string>
#include <vector>

#include "engine/execution.h"
#include "engine/matching/options/match_options.h"
#include "engine/matching/stereo_matcher.h"
#include "perf/peers.h"
#include "perf/quality/true_scenes.h"

namespace vantage::perf {

/// Post-processing of StereoSGBM's winners that differs between settings, in this order. Our
/// cross-check at 1 px comes before our speckle removal; filling with medians is the last step.
struct SgbmPostProcessing {
  int uniqueness_percent;  ///< margin by which the winner must beat the others
  int opencv_speckle_px;   ///< maximum region size for OpenCV's speckle filter, in pixels; 0: none
  int opencv_speckle_range_px;
  int speckle_size_px;  ///< ours
};

/// "uniqueness 10, speckles 100/2, our speckles 0"
std::string to_text(const SgbmPostProcessing& post_processing);

struct SgbmSetting {
  std::string name;
  int mode;  ///< cv::StereoSGBM's
  int block_px;
  SgbmPostProcessing post_processing;
};

/// Three modes × two blocks, each with the post-processing that --search-peers found best for it.
const std::vector<SgbmSetting>& sgbm_settings();

/// A matcher that leaves everything after the uniqueness test to the functions below.
cv::Ptr<cv::StereoSGBM> make_sgbm_matcher(const SgbmSetting& setting, const ScenePair& pair);

void filter_opencv_speckles(const SgbmPostProcessing& post_processing, DisparityRange range,
                            cv::Mat& disparities);
/// Computes dense maps from the pixels that OpenCV's filter keeps.
void refine_peer_maps(const SgbmPostProcessing& post_processing, const ScenePair& pair,
                      const PeerDisparities& disparities, Execution& execution,
                      DisparityMaps& refined);

}  // namespace vantage::perf
