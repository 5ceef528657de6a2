#include "engine/jobs/list_columns.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "engine/combinations/combinations.h"
#include "engine/error.h"
#include "engine/io/files/checksum.h"
#include "engine/io/maps/map_io.h"
#include "engine/sequence/options/sequence_values.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;

/// Throws UsageError where the options cannot search the range of one pair.
void check_range(const MatchOptions& options, DisparityRange range, const std::string& images) {
  MatchOptions of_pair = options;
  of_pair.disparities = range;
  of_pair.disparities_auto = false;
  try {
    of_pair.validate();
  } catch (const UsageError& error) {
    throw UsageError(fmt::format("{}: {}", images, error.what()));
  }
}

/// What the columns do not go together with.
void check_options(const SequenceJob& job, const ListColumns& columns) {
  OptionValues values = values_of(job.sequence);
  values.set("kept-outline", job.rectification.kept_outline);
  if (job.calibration_choice.kitti_cameras) {
    values.set("kitti-cameras", "given");
  }
  if (job.calibration_choice.lens) {
    values.set("lens", "given");
  }
  if (!job.calibration.empty()) {
    values.set("calibration", job.calibration);
  }
  if (!columns.calibrations.empty()) {
    values.set("column calibration", "given");
  }
  if (columns.widest) {
    values.set("column min-disparity", "given");
  }
  refuse_combinations(CombinationScope::kPairList, values);
}

/// The cameras of a KITTI file are `chosen`, else those that the folders of the images name.
StereoCalibration read_listed(const RigScale& rig, const CalibrationChoice& chosen,
                              const PairDetails& pair) {
  const std::string file = pair.calibration.string();
  StereoCalibration calibration = rig.read(file, {.kitti_cameras = {}, .lens = chosen.lens});
  const std::optional<KittiCameras> cameras = chosen.kitti_cameras || !calibration.has_other_cameras
                                                  ? chosen.kitti_cameras
                                                  : pair.kitti_cameras;
  return calibration.kitti_cameras && cameras && calibration.kitti_cameras != cameras
             ? rig.read(file, {.kitti_cameras = cameras, .lens = chosen.lens})
             : calibration;
}

/// Throws UsageError for options that a calibration of one pair contradicts, Error for one that
/// cannot be used.
void check_calibration(const SequenceJob& job, const PairCameras::Options& cameras,
                       const PairDetails& pair, const std::string& images) {
  if (job.rig.focal_length_px) {
    throw UsageError(fmt::format(
        "--focal-length is given, but {} has a calibration of its own, expected one of both",
        images));
  }
  const StereoCalibration calibration = cameras.read(pair);
  if (job.sequence.is_metric()) {
    (void)job.rig.required_unit_of(calibration);
  }
}

}  // namespace

ListColumns check_list_columns(const SequenceJob& job, const PairSource& pairs) {
  ListColumns columns;
  if (job.input.pairs.empty()) {
    return columns;
  }
  const PairCameras::Options cameras = pair_camera_options(job);
  columns.all_have_ranges = true;
  for (int pair = 0; pair < pairs.pair_count(); ++pair) {
    const PairDetails details = pairs.details(pair);
    if (!details.calibration.empty()) {
      if (columns.calibrations.insert({details.calibration, details.kitti_cameras}).second) {
        check_calibration(job, cameras, details, pairs.describe(pair));
      }
    } else if (job.sequence.is_metric() && job.cameras_file().empty() && !job.rig.focal_length_px) {
      throw UsageError(fmt::format(
          "--save depth, depth-resolution, cloud or mesh is in metres, but {} has no calibration",
          pairs.describe(pair)));
    }
    columns.all_have_ranges = columns.all_have_ranges && details.disparities;
    if (details.disparities) {
      check_range(job.sequence.match, *details.disparities, pairs.describe(pair));
      require_holds_search("map." + job.sequence.map_format, details.disparities->min,
                           details.disparities->max);
      if (!columns.widest || columns.widest->count() < details.disparities->count()) {
        columns.widest = details.disparities;
      }
    }
  }
  if (columns.calibrations.empty() && job.cameras_file().empty()) {
    job.rig.validate("");
  }
  check_options(job, columns);
  return columns;
}

void use_ranges(const ListColumns& columns, MatchOptions& options) {
  if (options.disparities_auto && columns.all_have_ranges) {
    options.disparities = *columns.widest;
    options.disparities_auto = false;
  }
}

PairCameras::Options pair_camera_options(const SequenceJob& job) {
  return {
      .rectification = job.rectification,
      .reference = job.sequence.match.reference,
      // What is chosen for the calibration of the run later is not for these.
      .read = [&job, chosen = job.calibration_choice](
                  const PairDetails& pair) { return read_listed(job.rig, chosen, pair); },
      .metres_per_unit =
          [&job](const StereoCalibration& calibration) { return job.rig.unit_of(calibration); }};
}

std::vector<std::string> column_identities(const PairSource& pairs) {
  std::vector<std::string> lines;
  std::set<fs::path> calibrations;
  Fnv1aHash hash;
  bool has_columns = false;
  for (int pair = 0; pair < pairs.pair_count(); ++pair) {
    const PairDetails details = pairs.details(pair);
    has_columns = has_columns || details != PairDetails();
    const std::string range = details.disparities ? fmt::format("{}:{}", details.disparities->min,
                                                                details.disparities->max)
                                                  : "";
    hash.add(
        fmt::format("{}\n{}\n{}\n", details.name, details.calibration.filename().string(), range));
    if (!details.calibration.empty() && calibrations.insert(details.calibration).second) {
      FileIdentity identity;
      for (const fs::path& file : calibration_files(details.calibration)) {
        identity.add(file.filename().string(), file);
      }
      lines.push_back(fmt::format("calibration {}: {}", details.calibration.filename().string(),
                                  identity.to_string()));
    }
  }
  if (has_columns) {
    lines.push_back(fmt::format("columns of the list: hash {:016x}", hash.value()));
  }
  return lines;
}

}  // namespace vantage
