#include "apps/match/match_run.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <optional>
#include <span>
#include <utility>

#include "apps/commands/commands.h"
#include "apps/inputs/automatic_disparities.h"
#include "apps/inputs/kitti_cameras_choice.h"
#include "apps/inputs/pair_input.h"
#include "apps/inputs/rectification_check.h"
#include "apps/match/match_outputs.h"
#include "apps/match/vertical_pair.h"
#include "apps/process/command_work.h"
#include "apps/process/tell.h"
#include "apps/reports/remarks.h"
#include "apps/reports/run_report.h"
#include "apps/settings/applied_tuning.h"
#include "engine/error.h"
#include "engine/image/memory_use.h"
#include "engine/image/orientation.h"
#include "engine/image/white_level.h"
#include "engine/io/images/photograph_io.h"
#include "engine/matching/options/method_names.h"
#include "engine/matching/pair_matcher.h"
#include "engine/matching/search/epipolar/rectified_map.h"
#include "engine/matching/selection/cyclopean_map.h"
#include "engine/matching/stereo_matcher.h"
#include "engine/matching/unrectified_matcher.h"
#include "engine/rectification/rectifier.h"
#include "engine/rectification/stereo_calibration.h"

namespace vantage::apps {
namespace {

void require_equal_sizes(const MatchJob& job, const std::vector<Photograph>& images) {
  const std::vector<std::string> names = job.inputs();
  const Photograph& first = images.front();
  for (std::size_t i = 1; i < images.size(); ++i) {
    if (images[i].width() != first.width() || images[i].height() != first.height()) {
      throw Error(fmt::format("{} is {}x{} but {} is {}x{}, expected equal sizes", names[i],
                              images[i].width(), images[i].height(), names[0], first.width(),
                              first.height()));
    }
    require_equal_turns(first, images[i]);
  }
}

/// Rectifies a pair in place if its calibration says so.
void rectify(const MatchJob& job, const DepthGeometry& geometry, std::vector<Photograph>& images,
             Execution& execution, RunReport& report) {
  const Rectifier* const rectifier = geometry.rectifier();
  if (rectifier == nullptr) {
    return;
  }
  if (job.has_several()) {
    throw Error(
        fmt::format("{}: is of cameras that are not rectified, expected one of rectified "
                    "images with --baselines",
                    job.depth.calibration));
  }
  report.timed_compute("rectify", [&] {
    for (const Side side : {Side::kLeft, Side::kRight}) {
      Photograph rectified;
      Photograph& image = images[index_of(side)];
      rectifier->apply(image, side, rectified, execution);
      image = std::move(rectified);
    }
  });
}

Side side_of(const MatchJob& job) { return job.is_left() ? Side::kLeft : Side::kRight; }

std::vector<Photograph> read_images(const MatchJob& job, RunReport& report) {
  std::vector<Photograph> images;
  for (const std::string& input : job.inputs()) {
    images.push_back(
        report.timed_file_access("read", [&] { return read_photograph(input, job.reading); }));
  }
  require_equal_sizes(job, images);
  std::vector<Photograph*> all;
  for (Photograph& image : images) {
    all.push_back(&image);
  }
  tell_remarks(scale_to_white_level(all, job.white_level), job.common, report);
  report.timed_file_access("read", [&] { leave_out_of_pair(job.masks, images[0], images[1]); });
  return images;
}

/// The images in the shape in which they are matched, and their cameras.
struct MatchInputs {
  MatchInputs(const MatchJob& job, Execution& execution, RunReport& report)
      : images(read_images(job, report)),
        size{images[0].width(), images[0].height()},
        camera_geometry(job.depth, size.columns, size.rows, job.vertical),
        camera(camera_geometry.camera(side_of(job))),
        first_is_left(!job.has_several() || job.is_left()) {
    tell_remarks(camera_geometry.remarks(), job.common, report);
    rectify(job, camera_geometry, images, execution, report);
    if (job.vertical) {
      transpose(images);
    }
    require_volume_rows(job.volume, job.vertical ? images[0].width() : images[0].height());
    if (!job.unrectified.empty()) {
      rectifier.emplace(read_stereo_calibration(job.unrectified, job.depth.calibration_choice),
                        size.columns, size.rows);
      tell_remarks(rectifier->pair().remarks, job.common, report);
      for (const Side side : {Side::kLeft, Side::kRight}) {
        rectifier->apply(images[index_of(side)], side, rectified[index_of(side)], execution);
      }
    }
  }

  /// Corrects the right image where that is wanted; its maps are then on corrected rows.
  void correct(const MatchJob& job, Execution& execution, RunReport& report) {
    if (!job.rows.check || job.match.disparities_y || job.match.disparities_y_auto || rectifier) {
      return;
    }
    // Volumes and what is made of them are not brought back.
    const bool can_correct = !job.has_several() &&
                             (job.is_left() || (job.volume.file.empty() && !job.wants_posterior()));
    rows = correct_rows({.common = job.common,
                         .mode = can_correct ? job.rows.mode : RowMode::kAsIs,
                         .expects_negative = expects_negative_disparities(job.match),
                         .lines = job.vertical ? "columns" : "rows"},
                        left(), images[first_is_left ? 1 : 0], execution, report);
  }
  /// The right image and its maps as they were given.
  void bring_back(DisparityMaps& maps, Execution& execution) {
    if (rows) {
      bring_to_given_rows(rows->field, maps.right, execution);
      images[1] = std::move(rows->given);
    }
  }

  /// A rectified pair, for what is estimated before the match.
  [[nodiscard]] const Photograph& left() const {
    return rectifier ? rectified[0] : images[first_is_left ? 0 : 1];
  }
  [[nodiscard]] const Photograph& right() const {
    return rectifier ? rectified[1] : images[first_is_left ? 1 : 0];
  }

  std::vector<Photograph> images;
  scheduler::Extent size;  ///< of the files
  DepthGeometry camera_geometry;
  std::optional<MapCamera> camera;  ///< of the map, if it is known
  bool first_is_left;
  std::optional<Rectifier> rectifier = std::nullopt;  ///< of --unrectified
  std::array<Photograph, 2> rectified = {};           ///< by it
  std::optional<CorrectedRows> rows = std::nullopt;   ///< of the right image
};

void match_images(const MatchJob& job, const StereoMatcher& matcher,
                  const std::vector<Photograph>& images, std::span<const VolumeRequest> volumes,
                  DisparityMaps& maps, MatchReport& report) {
  const MatchRequest request{
      .left = job.is_left() || job.wants_cyclopean(),
      .right = job.wants_right(),
      .unmatched = !(job.unmatched.empty() && job.unmatched_right.empty()) ||
                   job.wants_cyclopean() || job.depth.outputs.reads_unmatched(),
      .probability = !job.confidence.empty() || job.depth.outputs.reads_confidence(),
      .volumes = volumes};
  if (!job.has_several()) {
    matcher.match(images[0], images[1], request, maps, &report);
    return;
  }
  std::vector<OtherView> others;
  for (std::size_t i = 1; i < images.size(); ++i) {
    others.push_back({&images[i], job.baselines[i - 1]});
  }
  matcher.match_several(images[0], others, request, maps, &report);
}

void match_unrectified(const MatchJob& job, const Rectifier& rectifier,
                       const std::vector<Photograph>& images, Execution& execution,
                       DisparityMaps& maps, MatchReport& report) {
  UnrectifiedMatcher(job.match, rectifier, execution)
      .match(images[0], images[1],
             {.left = job.is_left(),
              .right = job.wants_right(),
              .probability = !job.confidence.empty()},
             maps, &report);
  if (job.rectified_pixels) {
    bring_to_rectified(rectifier, Side::kLeft, execution, maps.left);
    bring_to_rectified(rectifier, Side::kRight, execution, maps.right);
  }
}

MemoryUse memory_use(const MatchInputs& inputs, const DisparityMaps& maps,
                     const StereoMatcher& matcher, Execution& execution) {
  MemoryUse use;
  for (const Photograph& image : inputs.images) {
    use.add("photographs", held_bytes(image));
  }
  if (inputs.rows) {
    use.add("photographs", held_bytes(inputs.rows->given));
  }
  use.add("maps", held_bytes(maps));
  matcher.add_memory_use(use);
  add_scratch_use(execution, use);
  return use;
}

AppliedTuning tuning_of(const MatchJob& job, const MatchInputs& inputs, const Settings& settings) {
  if (job.has_several()) {
    return no_tuning("tuning is for pairs, but there are more images");
  }
  if (inputs.rectifier) {
    return no_tuning("tuning is for rectified pairs");
  }
  return apply_tuning(job.tuning,
                      {.match = job.match,
                       .execution = job.common.execution,
                       .left = inputs.left(),
                       .right = inputs.right()},
                      settings.command(), job.common.quiet);
}

/// What a match makes.
struct Matched {
  DisparityMaps maps;
  CyclopeanMap cyclopean;
  MatchReport report;
};

/// Matches, and warns of images and ranges that do not suit each other. `asked`: the options before
/// the range was found.
void compute_maps(const MatchJob& job, const MatchInputs& inputs, const MatchOptions& asked,
                  const StereoMatcher& matcher, std::span<const VolumeRequest> volumes,
                  Execution& execution, RunReport& report, Matched& matched) {
  report.timed_compute([&] {
    if (inputs.rectifier) {
      match_unrectified(job, *inputs.rectifier, inputs.images, execution, matched.maps,
                        matched.report);
    } else {
      match_images(job, matcher, inputs.images, volumes, matched.maps, matched.report);
    }
  });
  if (!job.has_several() && !inputs.rectifier) {
    warn_of_cut_range(job.common, inputs.left(), inputs.right(), matched.maps, job.match,
                      asked.disparities_auto, execution, report);
  }
  if (job.wants_cyclopean()) {
    make_cyclopean_map(matched.maps.left, execution, matched.cyclopean);
  }
}

/// Writes the maps, and all that is made of them. Returns what it wrote of depths.
DepthFiles write_outputs(const MatchJob& job, const MatchInputs& inputs, const Matched& matched,
                         SpaceOutputs& space, Execution& execution, RunReport& report) {
  const Side side = side_of(job);
  const MatchedMap& map = matched.maps.of(side);
  const auto along_baseline_px =
      (job.vertical && job.match.disparities_y ? map.disparity_y_px : map.disparity_px).view();
  const std::optional<DepthScale> scale =
      inputs.camera ? std::optional(inputs.camera->scale) : std::nullopt;
  if (const auto disparities =
          job.common.report.empty() ? std::nullopt : disparity_quantiles(along_baseline_px)) {
    report.add_result("depth_resolution",
                      depth_resolution_values(*disparities, scale, job.disparity_resolution_px()));
  }
  Image<float> depth_resolution;
  if (!job.depth.resolution_file.empty()) {
    depth_resolution_map(along_baseline_px, *scale, job.disparity_resolution_px(), execution,
                         depth_resolution);
  }
  const Photograph& reference = inputs.images[job.has_several() ? 0 : index_of(side)];
  DepthFiles depths =
      depth_files(job, inputs.camera, reference, map, along_baseline_px, execution, report);
  report.timed_file_access("write", [&] {
    write_results(job, matched.maps, depth_resolution, depths, execution);
    write_space(job, space, report);
    write_cyclopean(job, matched.cyclopean);
  });
  return depths;
}

/// Prints what was matched and where it was written.
void print_results(const MatchJob& job, scheduler::Extent size, const DepthFiles& depths,
                   const SpaceOutputs& space) {
  tell("match: {} ({}), {}x{} pixels, disparities {}:{}, {} -> {}\n", job.match.chosen(),
       summary_of(job.match.resolved()), size.columns, size.rows, job.match.disparities.min,
       job.match.disparities.max, job.left, fmt::join(job.written_maps(), ", "));
  if (!job.preview.empty()) {
    tell("match: {}: blue is {} px (far), red {} px (near), black unknown\n", job.preview,
         job.match.disparities.min, job.match.disparities.max);
  }
  for (const std::string& summary : depths.summaries) {
    tell("match: {}\n", summary);
  }
  if (space.volume) {
    tell("match: {}\n", volume_summary(job.volume, *space.volume));
  }
}

}  // namespace

int run_match(MatchJob& job, const Settings& settings) {
  name_views(job.left, job.right);
  check(job, settings);
  const std::vector<std::string> files = job.inputs();
  choose_kitti_cameras(
      settings, job.common, job.unrectified.empty() ? job.depth.calibration : job.unrectified,
      std::vector<std::filesystem::path>(files.begin(), files.end()), job.depth.calibration_choice);
  CommandWork work(settings, job.common, reported_settings(settings, job.match));
  RunReport& report = work.report;

  MatchInputs inputs(job, work.execution, report);
  inputs.correct(job, work.execution, report);
  const MatchOptions asked = job.match;
  choose_disparities(settings, job.common, inputs.left(), inputs.right(), job.match, work.execution,
                     report);
  require_files_hold_search(job);
  const AppliedTuning tuning = tuning_of(job, inputs, settings);
  report.set_tuning(tuning.report, tuning.summary);
  std::optional<Execution> tuned_execution;
  if (tuning.settings != TunedSettings{}) {
    tuned_execution.emplace(with_tuned(job.common.execution, tuning.settings));
    report.set_execution(*tuned_execution);
  }
  Execution& execution = tuned_execution ? *tuned_execution : work.execution;

  MatchOptions options = job.match;
  if (job.vertical && options.roi) {  // of the image before rows and columns were exchanged
    options.roi = ImageRegion{options.roi->y_px, options.roi->x_px, options.roi->height_px,
                              options.roi->width_px};
  }
  const StereoMatcher matcher(options, execution);
  Matched matched;
  SpaceOutputs space(job);
  compute_maps(job, inputs, asked, matcher, space.requests(job), execution, report, matched);
  if (space.posterior) {
    space.posterior->erase(inputs.images[job.has_several() ? 0 : index_of(side_of(job))].left_out);
  }
  tell_match(matched.report, job.common, report);
  report.set_memory(memory_use(inputs, matched.maps, matcher, execution));
  inputs.bring_back(matched.maps, execution);
  if (job.vertical) {
    transpose(matched.maps);
    transpose(matched.cyclopean);
    if (job.depth.outputs.has_points()) {
      transpose(inputs.images);
    }
  }
  const DepthFiles depths = write_outputs(job, inputs, matched, space, execution, report);
  report.write(job.common.report);
  if (!job.common.quiet) {
    print_results(job, inputs.size, depths, space);
    tell_shares(matched.report, job.common, report);
    report.print_summary();
  }
  return kExitDone;
}

}  // namespace vantage::apps
