#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/image/stereo_display.h"
#include "engine/io/images/preview.h"
#include "engine/io/video/film_format.h"
#include "engine/io/video/frame_rate.h"
#include "engine/io/video/video_coding.h"
#include "engine/matching/options/match_options.h"
#include "engine/rectification/rows/row_track.h"
#include "engine/reprojection/point_cloud.h"
#include "engine/sequence/past/temporal_options.h"
#include "engine/synthesis/synthesis_options.h"
#include "engine/view_geometry/view_pose.h"

namespace vantage {

/// Outputs of a sequence run, per frame.
enum class SequenceOutput {
  kDisparity,       ///< map of the reference image
  kRightDisparity,  ///< map of the right image in addition to that of the left one
  kConfidence,      ///< of the reference's map
  kUnmatched,       ///< mask of the filled pixels of the reference's map
  kRightUnmatched,
  kPreview,             ///< the reference's map in colours
  kViews,               ///< new views
  kHoles,               ///< masks of view pixels that no image shows
  kSources,             ///< masks of the source images of view pixels, see SynthesizedView
  kStereo,              ///< two views in one picture
  kPosteriorMean,       ///< of p(d) of the reference's pixels (PosteriorMoments)
  kPosteriorVariance,   ///< likewise
  kCyclopean,           ///< map of a camera in the middle of both, see CyclopeanMap
  kCyclopeanOcclusion,  ///< mask of what each camera sees of it
  kDepth,               ///< of the reference's map, in metres
  kDepthResolution,     ///< δZ of the reference's map, in metres, see depth_resolution_map()
  kCloud,               ///< points of the reference's map
  kMesh,                ///< the points as triangles
  kDepthVideo,          ///< the reference's map as a grey video, see DepthVideoScale
  kComfort              ///< how comfortable the pairs are to watch: a report of all frames
};

/// Names of the outputs on the command line, which are also those of their folders.
const std::vector<std::pair<std::string_view, SequenceOutput>>& sequence_output_names();

/// Whether there is one per new view.
constexpr bool is_per_view(SequenceOutput output) {
  return output == SequenceOutput::kViews || output == SequenceOutput::kHoles ||
         output == SequenceOutput::kSources;
}

/// Whether it is in metres: such runs need the camera of the maps.
constexpr bool is_metric(SequenceOutput output) {
  return output == SequenceOutput::kDepth || output == SequenceOutput::kDepthResolution ||
         output == SequenceOutput::kCloud || output == SequenceOutput::kMesh;
}
/// Whether a video can hold it.
bool is_picture(SequenceOutput output);

/// Whether the output is always a video.
constexpr bool is_always_video(SequenceOutput output) {
  return output == SequenceOutput::kDepthVideo;
}

/// What its video states of pictures made of `film`: all have the shape of its pixels, and those
/// that show what it shows its colours.
inline FilmFormat film_format_of(SequenceOutput output, const FilmFormat& film) {
  const bool shows_film = output == SequenceOutput::kViews || output == SequenceOutput::kStereo;
  return {film.pixel_aspect, shows_film ? film.colours : FilmColours()};
}

/// Whether it is one for all frames instead of one per frame.
constexpr bool is_of_all_frames(SequenceOutput output) {
  return output == SequenceOutput::kComfort;
}

/// What the whole range of grey levels of a depth video stands for.
struct DepthVideoScale {
  enum class Scope {
    kFilm,  ///< the disparities searched in all frames
    kShot,  ///< those searched in the shot
    kGiven  ///< `given`
  };
  Scope scope = Scope::kFilm;
  PreviewRange given;  ///< min < max
  friend bool operator==(const DepthVideoScale&, const DepthVideoScale&) = default;
};

/// Frames over which a fitted quantity is estimated.
enum class FitScope {
  kFrame,  ///< each frame separately
  kShot    ///< once for all frames between two cuts
};

/// What is searched in one range of disparities, unless that is given.
enum class SearchScope {
  kFilm,  ///< all frames: match.disparities
  kShot,  ///< the range found in some pairs of a shot, match.disparities where none is found
  kPair   ///< that of the pair alone: of pairs that have nothing to do with each other
};

/// Whether rectification is part of the search (UnrectifiedMatcher), and whose pixels maps have.
enum class UnrectifiedSearch {
  kNone,           ///< pairs are rectified, if needed before the search
  kOnPhotographs,  ///< maps are on the pixels of the photographs
  kOnRectified     ///< they are brought to those of the rectified images
};

/// Everything that determines which files a sequence run writes and their content.
struct SequenceOptions {
  MatchOptions match;  ///< without disparities_y
  /// Of the right camera and those of FramePair::more, relative to the left one; the first is
  /// positive. Empty: pairs. Maps are then of all images at once (StereoMatcher::match_several()),
  /// without a cross-check.
  std::vector<double> baselines;
  UnrectifiedSearch unrectified = UnrectifiedSearch::kNone;
  /// How the rows of right images are corrected. Right maps are then brought back to the pixels of
  /// the given images; views show the corrected ones.
  RowTrack rows;
  bool corrects_rows_per_pair = false;  ///< instead, pairs are unrelated: each by its own points
  SynthesisOptions synthesis;
  std::vector<SequenceOutput> save = {SequenceOutput::kDisparity};  ///< at least one
  /// Outputs of `save` written as one H.264 video each instead of an image per frame; not maps of
  /// floats.
  std::vector<SequenceOutput> video;
  /// New views; some exactly when kViews, kHoles or kSources is saved. Cameras are in the frame of
  /// the rectified left one, a size of 0×0 stands for that of the images; positions are within ±16.
  std::vector<ViewPath> views;
  /// Rotates the views given as positions, see camera_looking_at(); empty: they look ahead.
  std::optional<double> look_at_px;
  /// The positions XS of the two views of kStereo; 0 and 1 are the photographs themselves.
  std::array<double, 2> stereo_views_x = {0, 1};
  StereoDisplay stereo_packing;
  FitScope intensity_fit = FitScope::kFrame;      ///< of the new views (3.9–3.11)
  bool preview_range_per_shot = false;            ///< else the range of the search
  SearchScope search_scope = SearchScope::kFilm;  ///< with TemporalOptions::uses_past() always this
  DepthVideoScale depth_scale;                    ///< of kDepthVideo
  VideoCoding depth_coding = VideoCoding::kHuffYuv_16;  ///< of kDepthVideo, a grey one
  TemporalOptions temporal;
  /// Extension of the disparity, confidence and depth resolution files without the dot, one of
  /// map_formats() that can hold them: all except png can hold the last two.
  std::string map_format = "pfm";
  /// Extension of the depth files without the dot, one of map_formats() that can hold them.
  std::string depth_format = "png";
  /// Difference of disparities that can be told apart, for kDepthResolution, above 0; empty: see
  /// disparity_resolution_px().
  std::optional<double> disparity_step_px = std::nullopt;
  CloudOptions cloud;    ///< of kCloud and kMesh; its max_depth in metres also of kDepth
  FrameRate frame_rate;  ///< of written videos
  FilmFormat film;       ///< of the input: what written videos state, see film_format_of()
  int crf = 18;          ///< of written videos, see VideoEncoding
  bool sound = true;     ///< videos include the sound of the input
  /// Frames per chunk; at its ends videos are cut into segments and no state passes from frame to
  /// frame, see FrameSelection; 1..100000.
  int chunk_frames = 50;

  /// Throws UsageError naming the field, its value and its limit.
  void validate() const;
  [[nodiscard]] bool saves(SequenceOutput output) const;
  [[nodiscard]] bool saves_as_video(SequenceOutput output) const;
  [[nodiscard]] bool corrects_rows() const { return corrects_rows_per_pair || !rows.keys.empty(); }
  [[nodiscard]] bool saves_posterior() const {
    return saves(SequenceOutput::kPosteriorMean) || saves(SequenceOutput::kPosteriorVariance);
  }
  [[nodiscard]] bool saves_cyclopean() const {
    return saves(SequenceOutput::kCyclopean) || saves(SequenceOutput::kCyclopeanOcclusion);
  }
  [[nodiscard]] bool saves_points() const {
    return saves(SequenceOutput::kCloud) || saves(SequenceOutput::kMesh);
  }
  /// Whether the pairs are those of a film, whose disparities have both signs.
  [[nodiscard]] bool is_film() const {
    return saves(SequenceOutput::kDepthVideo) || saves(SequenceOutput::kComfort);
  }
  /// Whether the camera of the maps must be known.
  [[nodiscard]] bool is_metric() const {
    return saves(SequenceOutput::kDepth) || saves(SequenceOutput::kDepthResolution) ||
           saves_points();
  }
  /// δ of kDepthResolution.
  [[nodiscard]] double used_disparity_step_px() const {
    return disparity_step_px.value_or(disparity_resolution_px(match.resolved()));
  }
  /// Whether shots must be found before the run.
  [[nodiscard]] bool needs_shots() const {
    return needs_matched_shots() || search_scope == SearchScope::kShot || is_film();
  }
  /// Whether pairs of each shot must be matched for that.
  [[nodiscard]] bool needs_matched_shots() const {
    return intensity_fit == FitScope::kShot || preview_range_per_shot;
  }
};

}  // namespace vantage
