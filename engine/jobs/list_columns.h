#pragma once

#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "engine/image/disparity_range.h"
#include "engine/jobs/sequence_job.h"
#include "engine/sequence/pairs/pair_cameras.h"
#include "engine/sequence/pairs/pair_source.h"

namespace vantage {

/// What the further columns of a list of pairs hold (PairDetails).
struct ListColumns {
  /// Files of pairs of their own, and PairDetails::kitti_cameras.
  std::set<std::pair<std::filesystem::path, std::optional<KittiCameras>>> calibrations;
  std::optional<DisparityRange> widest;  ///< of the ranges of pairs, if any has one
  bool all_have_ranges = false;

  /// The one of more candidates.
  [[nodiscard]] DisparityRange widest_with(const DisparityRange& of_run) const {
    return widest && widest->count() > of_run.count() ? *widest : of_run;
  }
};

/// Looks at the columns of all pairs, and reads their calibrations; there are none but of a list.
/// Throws UsageError for options of the job that cannot be used with them, and where outputs in
/// metres lack the cameras of a pair; Error naming the file of a calibration that cannot be used.
ListColumns check_list_columns(const SequenceJob& job, const PairSource& pairs);

/// Where all pairs have ranges, none is to be found: `options` then have the widest.
void use_ranges(const ListColumns& columns, MatchOptions& options);

/// For pairs with calibrations of their own.
/// `job` must outlive them.
PairCameras::Options pair_camera_options(const SequenceJob& job);

/// For the journal: a line per calibration file, and one for names and ranges, if there are any.
std::vector<std::string> column_identities(const PairSource& pairs);

}  // namespace vantage
