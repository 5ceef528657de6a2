#pragma once

#include <optional>
#include <vector>

#include "apps/match/depth_outputs.h"
#include "apps/match/match_job.h"
#include "apps/reports/run_report.h"
#include "engine/execution.h"
#include "engine/image/disparity_maps.h"
#include "engine/io/maps/npy_volume_file.h"
#include "engine/matching/selection/cyclopean_map.h"
#include "engine/matching/volume/posterior_moments.h"
#include "engine/matching/volume/volume_request.h"

namespace vantage::apps {

/// Outputs of the disparity space.
struct SpaceOutputs {
  std::optional<NpyVolumeFile> volume;
  std::optional<PosteriorMoments> posterior;

  explicit SpaceOutputs(const MatchJob& job);
  [[nodiscard]] std::vector<VolumeRequest> requests(const MatchJob& job);
};

/// The content of the files in metres; none if none is wanted. `along_px`: disparities along the
/// baseline.
DepthFiles depth_files(const MatchJob& job, const std::optional<MapCamera>& camera,
                       const Photograph& colours, const MatchedMap& map,
                       ImageView<const float> along_px, Execution& execution, RunReport& report);

// Write the outputs that are wanted. Throw Error.
void write_results(const MatchJob& job, const DisparityMaps& maps,
                   const Image<float>& depth_resolution, const DepthFiles& depth_files,
                   Execution& execution);
void write_space(const MatchJob& job, SpaceOutputs& space, RunReport& report);
void write_cyclopean(const MatchJob& job, const CyclopeanMap& map);

}  // namespace vantage::apps
