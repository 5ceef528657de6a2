#pragma once

#include <string>
#include <vector>

#include "engine/execution.h"
#include "engine/matching/match_options.h"
#include "engine/matching/stereo_matcher.h"
#include "perf/peers.h"
#include "perf/quality/true_scenes.h"

namespace vantage::perf {

/// More than any difference: OpenCV 4.6 takes what it documents as "no check", 0 and less, for 1.
inline constexpr int kNoDisp12Check = 4096;

/// What is done to the winners of OpenCV's StereoSGBM, in this order.
struct SgbmPostProcessing {
  int uniqueness_percent;  ///< by which the winner must beat the others
  int disp12_max_diff_px;  ///< of OpenCV's own check, which looks at one volume
  int opencv_speckle_px;   ///< OpenCV's filter takes regions of at most so many pixels; 0: none
  int opencv_speckle_range_px;
  double cross_check_px;  ///< ours, of the maps of both images
  int speckle_size_px;    ///< ours
  Fill fill;
};

/// "uniqueness 10, disp12 1, …"
std::string to_text(const SgbmPostProcessing& post_processing);

struct SgbmSetting {
  std::string name;
  int mode;  ///< cv::StereoSGBM's
  int block_px;
  SgbmPostProcessing post_processing;
};

/// Three modes × two blocks, each with the post-processing that --search-peers found best for it.
const std::vector<SgbmSetting>& sgbm_settings();

/// Winners of both maps, before OpenCV's speckle filter. `matcher`: of make_sgbm_matcher().
cv::Ptr<cv::StereoSGBM> make_sgbm_matcher(const SgbmSetting& setting, const ScenePair& pair);

/// What make_sgbm_matcher() leaves to do.
void filter_opencv_speckles(const SgbmPostProcessing& post_processing, DisparityRange range,
                            PeerDisparities& disparities);
DisparityMaps refine_peer_maps(const SgbmPostProcessing& post_processing, const ScenePair& pair,
                               PeerMaps maps, Execution& execution);

}  // namespace vantage::perf
