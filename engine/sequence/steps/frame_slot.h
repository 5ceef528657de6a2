#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/comfort/frame_comfort.h"
#include "engine/image/disparity_range.h"
#include "engine/image/photograph.h"
#include "engine/io/video/libav.h"
#include "engine/matching/range_check.h"
#include "engine/matching/selection/cyclopean_map.h"
#include "engine/matching/stereo_matcher.h"
#include "engine/matching/volume/posterior_moments.h"
#include "engine/rectification/rows/row_field.h"
#include "engine/sequence/journal/pending_files.h"
#include "engine/sequence/journal/run_journal.h"
#include "engine/sequence/pairs/pair_cameras.h"
#include "engine/sequence/pairs/pair_source.h"
#include "engine/sequence/shots/shot_cuts.h"
#include "engine/sequence/shots/shot_matchers.h"
#include "engine/synthesis/view_synthesizer.h"
#include "engine/view_geometry/depth_resolution.h"
#include "engine/view_geometry/view_pose.h"

namespace vantage {

/// Buffers of one frame in flight; reused for later frames.
struct FrameSlot {
  int frame = 0;
  bool is_lead_in = false;  ///< computed only for the frames after it
  bool is_absent = false;   ///< the input ends before it: no results
  /// Existing files of the frame, if only its pictures for the videos are needed; null if they are
  /// to be written.
  const FrameRecord* stored = nullptr;
  FramePair pair;
  /// Of the pair's own calibration; null: the cameras of the run.
  std::shared_ptr<const PairCameras::Cameras> cameras;
  std::array<Photograph, 2> rectified;  ///< if a calibration is applied
  Photograph corrected;                 ///< the right image on the rows of the left one
  std::optional<RowField> rows;         ///< by which it was corrected
  const Photograph* left = nullptr;     ///< input of matching: of `pair`, `rectified`, `corrected`
  const Photograph* right = nullptr;
  std::array<std::uint64_t, 2> content = {};  ///< content_hash() of the pair
  std::optional<Thumbnail> thumbnail;         ///< of the left frame of a stream, to find shots
  bool maps_are_read = false;                 ///< from the files of `stored`, instead of matching
  DisparityRange searched;                    ///< the disparities searched for `maps`
  DisparityMaps maps;
  /// The maps on the grids of `pair`, if views use its colours (PhotographGrid).
  std::array<Image<float>, 2> photograph_maps;
  PosteriorMoments posterior;  ///< of the reference's pixels
  CyclopeanMap cyclopean;
  MatchReport match;
  std::shared_ptr<const ShotMatcher> shot;  ///< what the frame is matched by
  DeferredMatch deferred;                   ///< after `shot`, whose matcher it needs
  bool may_be_cut = false;                  ///< the range, by where matches lie
  std::optional<CutRange> cut;              ///< what a look at such a frame found
  /// The new views of SequenceOptions::views, then those of the stereo picture that are not
  /// photographs.
  std::vector<SynthesizedView> views;
  std::vector<ViewPose> view_poses;  ///< of `views`, as for new_view()
  Photograph preview;
  Photograph stereo;
  Photograph depth;                     ///< see paint_depth()
  std::optional<FrameComfort> comfort;  ///< if it is wanted
  /// Of the reference's map, with kDepthResolution.
  std::optional<DisparitiesAndScale> disparities;
  std::vector<LibavFrame> video_frames;  ///< of the videos in the order of the layout
  std::vector<std::uint8_t> encoded;     ///< the file being written
  PendingFiles files;
  std::vector<FileRecord> file_records;  ///< of `files`
  std::vector<StageTime> times;          ///< of all steps except matching

  /// Forgets the frame before; buffers are kept.
  void begin_frame();
  /// Null unless the view is at a camera's position.
  [[nodiscard]] const Photograph* photograph_at(double view_x) const {
    return view_x == 0 ? left : view_x == 1 ? right : nullptr;
  }
};

/// Bytes of a frame in flight, by the steps that fill it. Excludes data that its source has fetched
/// but not yet decoded.
std::size_t held_bytes(const FrameSlot& slot);

}  // namespace vantage
