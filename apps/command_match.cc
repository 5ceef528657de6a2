#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <optional>
#include <span>
#include <utility>

#include "apps/applied_tuning.h"
#include "apps/automatic_disparities.h"
#include "apps/command_work.h"
#include "apps/commands.h"
#include "apps/kitti_cameras_choice.h"
#include "apps/match_job.h"
#include "apps/match_outputs.h"
#include "apps/rectification_check.h"
#include "apps/run_report.h"
#include "apps/settings.h"
#include "apps/tell.h"
#include "apps/vertical_pair.h"
#include "engine/error.h"
#include "engine/image/memory_use.h"
#include "engine/io/photograph_io.h"
#include "engine/matching/options/method_names.h"
#include "engine/matching/selection/cyclopean_map.h"
#include "engine/matching/stereo_matcher.h"
#include "engine/matching/unrectified/rectified_map.h"
#include "engine/matching/unrectified/unrectified_matcher.h"
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

void match_images(const MatchJob& job, const StereoMatcher& matcher,
                  const std::vector<Photograph>& images, std::span<const VolumeRequest> volumes,
                  DisparityMaps& maps, MatchReport& report) {
  const MatchRequest request{
      .left = job.is_left() || job.wants_cyclopean(),
      .right = job.wants_right(),
      .unmatched = !(job.unmatched.empty() && job.unmatched_right.empty()) ||
                   job.wants_cyclopean() || job.depth.outputs.reads_unmatched(),
      .confidence = !job.confidence.empty() || job.depth.outputs.reads_confidence(),
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
              .confidence = !job.confidence.empty()},
             maps, &report);
  if (job.rectified_pixels) {
    bring_to_rectified(rectifier, Side::kLeft, execution, maps.left);
    bring_to_rectified(rectifier, Side::kRight, execution, maps.right);
  }
}

MemoryUse memory_use(const std::vector<Photograph>& images, const DisparityMaps& maps,
                     const StereoMatcher& matcher, Execution& execution) {
  MemoryUse use;
  for (const Photograph& image : images) {
    use.add("photographs", held_bytes(image));
  }
  use.add("maps", held_bytes(maps));
  matcher.add_memory_use(use);
  add_scratch_use(execution, use);
  return use;
}

AppliedTuning tuning_of(const MatchJob& job, bool is_unrectified, const Photograph& left,
                        const Photograph& right, const Settings& settings) {
  if (job.has_several()) {
    return no_tuning("tuning is for pairs, but there are more images");
  }
  if (is_unrectified) {
    return no_tuning("tuning is for rectified pairs");
  }
  return apply_tuning(
      job.tuning,
      {.match = job.match, .execution = job.common.execution, .left = left, .right = right},
      settings.command(), job.common.quiet);
}

/// Prints what was estimated.
void print_exposure(const MatchReport& match) {
  if (!match.exposure) {
    return;
  }
  const PairExposure& exposure = *match.exposure;
  std::string text = exposure.has_intensity_change
                         ? fmt::format("right intensity x {:.4g} {:+.4g}",
                                       exposure.of_right.luma.gain, exposure.of_right.luma.offset)
                         : "intensities unchanged";
  if (exposure.sigma_measurement) {
    text += fmt::format(", noise {:.3g}", *exposure.sigma_measurement);
  }
  tell("match: from {} matches: {}\n", exposure.matches, text);
}

/// Prints what was matched and where it was written.
void print_results(const MatchJob& job, scheduler::Extent size, const MatchReport& match,
                   const DepthFiles& depths, const SpaceOutputs& space) {
  tell("match: {} ({}), {}x{} pixels, disparities {}:{}, {} -> {}\n", job.match.chosen(),
       summary_of(job.match.resolved()), size.columns, size.rows, job.match.disparities.min,
       job.match.disparities.max, job.left, fmt::join(job.written_maps(), ", "));
  if (!job.preview.empty()) {
    tell("match: {}: blue is {} px (far), red {} px (near), black unknown\n", job.preview,
         job.match.disparities.min, job.match.disparities.max);
  }
  print_exposure(match);
  for (const std::string& summary : depths.summaries) {
    tell("match: {}\n", summary);
  }
  if (space.volume) {
    tell("match: {}\n", volume_summary(job.volume, *space.volume));
  }
}

}  // namespace

int command_match(const Arguments& arguments) {
  MatchJob job;
  Settings settings("match",
                    "Computes the disparity map of a rectified stereo pair, or of several images "
                    "taken on one line.");
  add_match_job_settings(settings, job);
  if (!settings.read(arguments)) {
    return kExitDone;
  }
  check(job, settings);
  const std::vector<std::string> inputs = job.inputs();
  choose_kitti_cameras(
      settings, job.common, job.unrectified.empty() ? job.depth.calibration : job.unrectified,
      std::vector<std::filesystem::path>(inputs.begin(), inputs.end()), job.depth.kitti_cameras);
  CommandWork work(settings, job.common, reported_settings(settings, job.match));
  RunReport& report = work.report;
  Execution& execution = work.execution;

  std::vector<Photograph> images;
  for (const std::string& input : inputs) {
    images.push_back(report.timed_file_access("read", [&] { return read_photograph(input); }));
  }
  require_equal_sizes(job, images);
  const scheduler::Extent size{images[0].width(), images[0].height()};
  const DepthGeometry geometry(job.depth, size.columns, size.rows, job.vertical);
  const Side side = job.is_left() ? Side::kLeft : Side::kRight;
  const std::optional<MapCamera> camera = geometry.camera(side);
  rectify(job, geometry, images, execution, report);
  if (job.vertical) {
    transpose(images);
  }
  require_volume_rows(job.volume, job.vertical ? images[0].width() : images[0].height());
  std::optional<Rectifier> rectifier;
  std::array<Photograph, 2> rectified;  // for the search range
  if (!job.unrectified.empty()) {
    rectifier.emplace(read_stereo_calibration(job.unrectified, job.depth.kitti_cameras),
                      size.columns, size.rows);
    rectifier->apply(images[0], Side::kLeft, rectified[0], execution);
    rectifier->apply(images[1], Side::kRight, rectified[1], execution);
  }
  const bool first_is_left = !job.has_several() || job.is_left();
  const Photograph& left = rectifier ? rectified[0] : images[first_is_left ? 0 : 1];
  const Photograph& right = rectifier ? rectified[1] : images[first_is_left ? 1 : 0];
  const bool expects_negative = expects_negative_disparities(job.match);
  const bool is_range_found = job.match.disparities_auto;
  choose_disparities(settings, job.common, left, right, job.match, execution, report);
  require_files_hold_search(job);
  const AppliedTuning tuning = tuning_of(job, rectifier.has_value(), left, right, settings);
  report.set_tuning(tuning.report, tuning.summary);
  std::optional<Execution> tuned_execution;
  if (tuning.settings != TunedSettings{}) {
    tuned_execution.emplace(with_tuned(job.common.execution, tuning.settings));
    report.set_execution(*tuned_execution);
  }
  Execution& chosen = tuned_execution ? *tuned_execution : execution;
  const StereoMatcher matcher(job.match, chosen);
  DisparityMaps maps;
  MatchReport match;
  SpaceOutputs space(job);
  const std::vector<VolumeRequest> volumes = space.requests(job);
  const auto compute = [&] {
    report.timed_compute([&] {
      if (rectifier) {
        match_unrectified(job, *rectifier, images, chosen, maps, match);
      } else {
        match_images(job, matcher, images, volumes, maps, match);
      }
    });
  };
  if (job.check_rectification && !job.match.disparities_y && !rectifier) {
    warn_unless_rectified_beside(compute, settings, job.common, expects_negative,
                                 job.vertical ? "columns" : "rows", left, right, chosen, report);
  } else {
    compute();
  }
  if (!job.has_several() && !rectifier) {
    warn_of_cut_range(settings, job.common, left, right, maps, job.match, is_range_found, chosen,
                      report);
  }
  CyclopeanMap cyclopean;
  if (job.wants_cyclopean()) {
    make_cyclopean_map(maps.left, chosen, cyclopean);
  }
  if (job.vertical) {
    transpose(maps);
    transpose(cyclopean);
  }
  report.add_match(match);
  report.set_memory(memory_use(images, maps, matcher, chosen));
  // Along the baseline.
  const MatchedMap& map = maps.of(side);
  const auto along_px =
      (job.vertical && job.match.disparities_y ? map.disparity_y_px : map.disparity_px).view();
  const std::optional<DepthScale> scale = camera ? std::optional(camera->scale) : std::nullopt;
  if (const auto disparities =
          job.common.report.empty() ? std::nullopt : disparity_quantiles(along_px)) {
    report.add_result("depth_resolution",
                      depth_resolution_values(*disparities, scale, job.disparity_resolution_px()));
  }
  Image<float> depth_resolution;
  if (!job.depth.resolution_file.empty()) {
    depth_resolution_map(along_px, *scale, job.disparity_resolution_px(), chosen, depth_resolution);
  }
  if (job.vertical && job.depth.outputs.has_points()) {
    transpose(images);
  }
  const Photograph& reference = job.has_several() ? images[0] : images[index_of(side)];
  const DepthFiles depths = depth_files(job, camera, reference, map, along_px, chosen, report);
  report.timed_file_access("write", [&] {
    write_results(job, maps, depth_resolution, depths);
    write_space(job, space, report);
    write_cyclopean(job, cyclopean);
  });

  report.write(job.common.report);
  if (!job.common.quiet) {
    print_results(job, size, match, depths, space);
    report.print_summary();
  }
  return kExitDone;
}

}  // namespace vantage::apps
