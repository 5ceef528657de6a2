#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/image/stereo_display.h"
#include "engine/io/frame_rate.h"
#include "engine/matching/options/match_options.h"
#include "engine/sequence/temporal_options.h"
#include "engine/synthesis/synthesis_options.h"
#include "engine/view_geometry/view_path.h"

namespace vantage {

/// What a sequence run can write for each frame.
enum class SequenceOutput {
  kDisparity,       ///< map of the reference image
  kRightDisparity,  ///< map of the right image beside that of the left one
  kConfidence,      ///< of the reference's map
  kUnmatched,       ///< mask of the pixels of the reference's map that were filled
  kRightUnmatched,
  kPreview,  ///< the reference's map in colours
  kViews,    ///< new views
  kHoles,    ///< masks of their pixels that no image shows
  kSources,  ///< masks of the images that their pixels are made of, see SynthesizedView
  kStereo    ///< two views in one picture
};

/// Names of the outputs on the command line, which are also those of their folders.
const std::vector<std::pair<std::string_view, SequenceOutput>>& sequence_output_names();

/// Whether there is one of each new view.
constexpr bool is_per_view(SequenceOutput output) {
  return output == SequenceOutput::kViews || output == SequenceOutput::kHoles ||
         output == SequenceOutput::kSources;
}

/// What a quantity that is fitted to the images is fitted to.
enum class FitScope {
  kFrame,  ///< each frame anew
  kShot    ///< once for all frames between two cuts
};

/// Everything that decides which files a sequence run writes and what is in them.
struct SequenceOptions {
  MatchOptions match;  ///< without disparities_y
  SynthesisOptions synthesis;
  std::vector<SequenceOutput> save = {SequenceOutput::kDisparity};  ///< at least one
  /// Of `save`, those written as one H.264 video each instead of an image per frame; maps of floats
  /// cannot be.
  std::vector<SequenceOutput> video;
  /// New views; some exactly when kViews, kHoles or kSources is saved. Cameras are in the frame of
  /// the rectified left one, a size of 0×0 stands for that of the images; positions are within ±16.
  std::vector<ViewPath> views;
  /// Turns the views that are given as positions, see camera_looking_at(); empty: they look ahead.
  std::optional<double> look_at_px;
  /// The positions XS of the two views of kStereo; 0 and 1 are the photographs themselves.
  std::array<double, 2> stereo_views_x = {0, 1};
  StereoDisplay stereo_packing;
  FitScope intensity_fit = FitScope::kFrame;  ///< of the new views (3.9–3.11)
  bool preview_range_per_shot = false;        ///< else the range of the search
  TemporalOptions temporal;
  bool measure_flicker = false;
  /// Extension of the disparity and confidence files without the dot, one of map_formats() that can
  /// hold them: of all, png alone holds no confidences.
  std::string map_format = "pfm";
  FrameRate frame_rate;  ///< of videos written
  int crf = 18;          ///< of videos written, see VideoEncoding
  bool sound = true;     ///< videos take over the sound of the input
  /// Frames between two points at which videos are cut into segments and nothing is handed on from
  /// frame to frame, see FrameSelection; 1..100000.
  int chunk_frames = 50;

  /// Throws UsageError naming the field, its value and its limit.
  void validate() const;
  [[nodiscard]] bool saves(SequenceOutput output) const;
  [[nodiscard]] bool saves_as_video(SequenceOutput output) const;
  /// Whether the sequence is looked over for shots before the run.
  [[nodiscard]] bool needs_shots() const {
    return intensity_fit == FitScope::kShot || preview_range_per_shot;
  }
};

}  // namespace vantage
