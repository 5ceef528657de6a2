#pragma once

#include <string>
#include <vector>

#include "engine/evaluation/view_evaluation.h"
#include "engine/execution.h"
#include "engine/image/image.h"
#include "engine/image/photograph.h"
#include "engine/options/setting_value.h"
#include "engine/remark.h"

namespace vantage::apps {

/// 255 where all colours of an 8-bit picture are 255. Masks often come with a palette, hence in
/// colour. Throws Error naming `path` for other depths.
Mask white_pixels(const Photograph& photograph, const std::string& path);

/// New views beside photographs of the same places.
struct ViewComparison {
  /// PSNR over the pixels of all frames; SSIM averaged over frames, weighted by their pixels.
  ViewScores scores;
  double immersive_psnr_db = 0;  ///< likewise
  ViewFlicker flicker;
  SettingValue frames;  ///< rows of a report, one per frame: its files and its scores
  std::vector<Remark> remarks;
};

/// `views`, `truth` and `mask` are each what open_frame_source() opens: a picture, a folder of
/// them, a pattern or a video; they are paired as the frames of cameras of a run are. `mask` may be
/// empty; a single one is that of all frames. Frames without a pixel in the mask count for flicker
/// alone. Throws Error for bad frames, and if no frame has a pixel to compare.
ViewComparison compare_views(const std::string& views, const std::string& truth,
                             const std::string& mask, Execution& execution);

}  // namespace vantage::apps
