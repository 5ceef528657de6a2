#include "apps/match/match_outputs.h"

#include "engine/image/transposed.h"
#include "engine/io/images/photograph_io.h"
#include "engine/io/maps/map_io.h"
#include "engine/sequence/shots/preview_range.h"

namespace vantage::apps {
namespace {

void write_map(const MatchJob& job, const std::string& path, const DisparityMaps& maps, Side side,
               Execution& execution) {
  const MatchedMap& map = maps.of(side);
  if (!job.match.disparities_y) {
    write_disparity(path, map.disparity_px.view(), &execution);
    return;
  }
  write_displacements(path, {map.disparity_px.view(), map.disparity_y_px.view()}, side);
}

void write_moments(const std::string& path, const Image<float>& values, bool is_vertical) {
  if (!path.empty()) {
    write_disparity(path, is_vertical ? transposed(values.view()).view() : values.view());
  }
}

}  // namespace

SpaceOutputs::SpaceOutputs(const MatchJob& job) {
  if (!job.volume.file.empty()) {
    volume.emplace(job.volume.file, job.volume.rows, job.vertical);
  }
  if (job.wants_posterior()) {
    posterior.emplace();
  }
}

std::vector<VolumeRequest> SpaceOutputs::requests(const MatchJob& job) {
  const Side side = job.is_left() ? Side::kLeft : Side::kRight;
  std::vector<VolumeRequest> requests;
  if (volume) {
    requests.push_back({side, job.volume.kind, job.volume.level, &*volume});
  }
  if (posterior) {
    requests.push_back({.side = side, .sink = &*posterior});
  }
  return requests;
}

DepthFiles depth_files(const MatchJob& job, const std::optional<MapCamera>& camera,
                       const Photograph& colours, const MatchedMap& map,
                       ImageView<const float> along_px, Execution& execution, RunReport& report) {
  if (!job.depth.outputs.any()) {
    return {};
  }
  const CloudSource source{.disparity_px = along_px,
                           .colours = &colours,
                           .unmatched = job.depth.outputs.reads_unmatched()
                                            ? map.unmatched.view()
                                            : ImageView<const std::uint8_t>(),
                           .confidence = map.confidence.view(),
                           .camera = *camera};
  return report.timed_compute(
      "depth", [&] { return make_depth_files(job.depth.outputs, source, execution, report); });
}

void write_results(const MatchJob& job, const DisparityMaps& maps,
                   const Image<float>& depth_resolution, const DepthFiles& depth_files,
                   Execution& execution) {
  const Side side = job.is_left() ? Side::kLeft : Side::kRight;
  const MatchedMap& map = maps.of(side);
  write_map(job, job.output, maps, side, execution);
  if (!job.output_right.empty()) {
    write_map(job, job.output_right, maps, Side::kRight, execution);
  }
  if (!job.confidence.empty()) {
    write_disparity(job.confidence, map.confidence.view());
  }
  if (!job.depth.resolution_file.empty()) {
    write_disparity(job.depth.resolution_file, depth_resolution.view(), &execution);
  }
  write_depth_files(job.depth.outputs, depth_files);
  if (!job.unmatched.empty()) {
    write_mask(job.unmatched, map.unmatched.view(), &execution);
  }
  if (!job.unmatched_right.empty()) {
    write_mask(job.unmatched_right, maps.right.unmatched.view(), &execution);
  }
  if (!job.preview.empty()) {
    const PreviewRange range = preview_range_of(job.match.disparities);
    // Along the baseline.
    const bool is_y = job.vertical && job.match.disparities_y;
    const DisparityMap& shown = is_y ? map.disparity_y_px : map.disparity_px;
    write_photograph(job.preview, {colour_preview(shown.view(), range.min_px, range.max_px)},
                     &execution);
  }
}

void write_space(const MatchJob& job, SpaceOutputs& space, RunReport& report) {
  if (space.posterior) {
    write_moments(job.posterior_mean, space.posterior->mean_px(), job.vertical);
    write_moments(job.posterior_variance, space.posterior->variance_px2(), job.vertical);
  }
  if (space.volume) {
    space.volume->commit();
    report.add_result("volume", volume_report(job.volume, *space.volume));
  }
}

void write_cyclopean(const MatchJob& job, const CyclopeanMap& map) {
  if (!job.cyclopean.empty()) {
    write_disparity(job.cyclopean, map.disparity_px.view());
  }
  if (!job.cyclopean_occlusion.empty()) {
    write_mask(job.cyclopean_occlusion, map.seen_by.view());
  }
}

}  // namespace vantage::apps
