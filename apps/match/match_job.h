#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/inputs/rectification_check.h"
#include "apps/settings/applied_tuning.h"
#include "apps/settings/common_options.h"
#include "apps/settings/depth_settings.h"
#include "engine/image/photograph_reading.h"
#include "engine/io/images/scene_mask.h"
#include "engine/matching/options/match_options.h"
#include "engine/options/match_settings.h"
#include "engine/options/settings.h"
#include "engine/options/volume_output.h"

namespace vantage::apps {

/// Everything a user can set about a match.
struct MatchJob {
  MatchOptions match = options_with_found_range();
  CommonOptions common;
  TuningSource tuning;
  DepthSettings depth;
  std::string left;
  std::string right;
  std::vector<std::string> more;  ///< images beyond the pair
  std::vector<double> baselines;  ///< of `right` and `more`; empty: a pair
  std::string output;
  std::string output_right;
  std::string confidence;
  std::string unmatched;
  std::string unmatched_right;
  std::string preview;
  std::string unrectified;  ///< calibration of photographs that are not rectified; empty: they are
  bool rectified_pixels = false;  ///< with `unrectified`: maps are on the rectified images
  VolumeOutput volume;
  std::string posterior_mean;
  std::string posterior_variance;
  std::string cyclopean;
  std::string cyclopean_occlusion;
  /// Cameras stand one above the other, the left image's above: columns are searched.
  bool vertical = false;
  std::optional<double> white_level;  ///< of all images; empty: see WhiteLevelSearch
  PhotographReading reading;
  RowSettings rows;
  SceneMaskOptions masks;

  /// δ of depths.
  [[nodiscard]] double disparity_resolution_px() const;
  [[nodiscard]] bool has_several() const { return !baselines.empty() || !more.empty(); }
  [[nodiscard]] std::vector<std::string> inputs() const {
    std::vector<std::string> all = {left, right};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  /// Files with maps, masks and the preview, the map first.
  [[nodiscard]] std::vector<std::string> written_maps() const;
  [[nodiscard]] bool wants_posterior() const {
    return !posterior_mean.empty() || !posterior_variance.empty();
  }
  [[nodiscard]] bool wants_cyclopean() const {
    return !cyclopean.empty() || !cyclopean_occlusion.empty();
  }
  /// Whether the map of the first image is one of a left image.
  [[nodiscard]] bool is_left() const {
    return has_several() ? baselines.front() > 0 : match.reference == Side::kLeft;
  }
  [[nodiscard]] bool wants_right() const {
    return !is_left() || !output_right.empty() || !unmatched_right.empty();
  }
};

/// Binds all of it: the options of 'vantage match'.
void add_match_job_settings(Settings& settings, MatchJob& job);

/// Throws UsageError where a map may hold disparities that its file cannot. Says nothing while the
/// range is not known (--disparities auto).
void require_files_hold_search(const MatchJob& job);

/// Throws UsageError where fields are wrong or do not go together, Error where results cannot be
/// written.
void check(const MatchJob& job, const Settings& settings);

}  // namespace vantage::apps
