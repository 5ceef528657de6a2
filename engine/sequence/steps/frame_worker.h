#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "engine/execution.h"
#include "engine/matching/stereo_matcher.h"
#include "engine/rectification/rectifier.h"
#include "engine/sequence/options/sequence_layout.h"
#include "engine/sequence/options/sequence_options.h"
#include "engine/sequence/pairs/frame_poses.h"
#include "engine/sequence/pairs/pair_source.h"
#include "engine/sequence/past/frame_reuse.h"
#include "engine/sequence/past/temporal_state.h"
#include "engine/sequence/shots/shot_matchers.h"
#include "engine/sequence/shots/shots.h"
#include "engine/sequence/steps/busy_clock.h"
#include "engine/sequence/steps/frame_slot.h"
#include "engine/sequence/steps/step_accounts.h"
#include "engine/synthesis/photograph_grid.h"
#include "engine/synthesis/pose_renderer.h"

namespace vantage {

/// Size of a new view of images of size `images`: that of its cameras if they have one.
ImageExtent extent_of(const ViewPath& view, ImageExtent images);

/// Whether views of rectified frames use the colours of the original photographs. False for the
/// book's warp, which moves pixels of rectified images.
bool views_show_photographs(const SequenceOptions& options);

/// Tools for processing frames. All must outlive the worker.
struct FrameTools {
  const SequenceOptions& options;
  const SequenceLayout& layout;
  const PairSource& pairs;                ///< for decoding
  std::optional<ImageExtent> frame_size;  ///< required for all frames; empty: any
  const Rectifier* rectifier;             ///< null: the pairs are rectified
  PairCameras* pair_cameras;              ///< null: no pair has a calibration of its own
  const RectifiedPair* cameras;           ///< of the pairs; null if no view needs them
  const MapCamera* map_camera;            ///< of the reference's map, in metres; null if not needed
  const FramePoses* poses;                ///< of the left camera; null: points are in its frame
  const ShotTable* shots;                 ///< null if the options need no shots
  Execution& execution;
  StepAccounts& accounts;
};

/// The steps of a frame between reading and writing. They depend on the frame and, if
/// TemporalOptions::uses_past(), on the frames before it in its chunk.
class FrameWorker {
 public:
  explicit FrameWorker(const FrameTools& tools);

  /// Whether compute() must be called in the order of the frames, one at a time.
  [[nodiscard]] bool computes_in_order() const { return options_.temporal.uses_past(); }

  /// Decodes and rectifies. Thread rule: concurrently for different slots; the same holds for
  /// finish() and encode(), and for compute() unless computes_in_order().
  void prepare(FrameSlot& slot) const;
  /// Maps, unless they need no other frame and can wait for finish(). Those of a stored frame are
  /// read if all that is needed is in files with their original content; otherwise it is no longer
  /// a stored frame. Throws Error if the images do not match.
  void compute(FrameSlot& slot);
  /// New views, pictures; for a stored frame, only the pictures of videos. Throws as compute().
  void finish(FrameSlot& slot);
  /// Writes the files of a frame that is neither a lead-in nor stored, without their final names.
  /// Throws OutputError.
  void encode(FrameSlot& slot) const;

  /// Time during which at least one frame was in compute() or finish(), or rectified.
  [[nodiscard]] double compute_seconds() const { return compute_clock_.seconds(); }

  /// Memory of matching, see StereoMatcher, and "frame before": what TemporalOptions::reuse keeps.
  void add_memory_use(MemoryUse& use) const {
    matchers_.add_memory_use(use);
    use.add("frame before", reuse_.held_bytes());
  }

  /// What is matched of a frame.
  [[nodiscard]] MatchRequest request() const;
  /// The disparities that a frame is searched in.
  [[nodiscard]] DisparityRange searched_in(const FrameSlot& slot) const {
    return matchers_.of(slot.frame, slot.pair.details.disparities)->options.disparities;
  }
  /// Of the reference's map, in metres; null: not known.
  [[nodiscard]] const MapCamera* map_camera_of(const FrameSlot& slot) const {
    if (slot.cameras == nullptr) {
      return map_camera_;
    }
    return slot.cameras->map_camera ? &*slot.cameras->map_camera : nullptr;
  }
  /// The disparities of the first and the last colour of its preview.
  [[nodiscard]] PreviewRange preview_range_of_frame(const FrameSlot& slot) const;
  /// Of the points of a frame; needs the camera of the maps.
  [[nodiscard]] MapCamera point_camera(const FrameSlot& slot) const;
  /// The reference's map.
  [[nodiscard]] const DisparityMap& primary_map(const FrameSlot& slot) const;
  /// Copies the picture of the frame in `stream` (not of floats) to `picture`, whose memory is
  /// reused.
  void copy_picture(const FrameSlot& slot, const OutputStream& stream, Photograph& picture) const;

 private:
  void match(FrameSlot& slot, const ShotMatcher& shot);
  /// Photographs that are not rectified.
  void match_along_lines(FrameSlot& slot, const UnrectifiedMatcher& matcher,
                         const MatchRequest& request) const;
  /// By all images of the frame.
  void match_images(FrameSlot& slot, const StereoMatcher& matcher,
                    const MatchRequest& request) const;
  void match_with_prior(FrameSlot& slot, const StereoMatcher& matcher, MatchRequest request,
                        bool is_first);
  void match_with_reuse(FrameSlot& slot, const StereoMatcher& matcher, MatchRequest request,
                        bool is_first);
  /// Looks at the first few frames for which the range may be too narrow.
  void check_range(FrameSlot& slot, const MatchOptions& options);
  /// The frame is no longer stored when a file has changed.
  void read_maps(FrameSlot& slot) const;
  /// Whether any result of the frame needs new views.
  [[nodiscard]] bool needs_views(const FrameSlot& slot) const;
  [[nodiscard]] bool wants(const FrameSlot& slot, SequenceOutput output) const;
  void synthesize(FrameSlot& slot) const;
  void paint_preview(FrameSlot& slot) const;
  void paint_depth_picture(FrameSlot& slot) const;
  /// Unless the frame is stored: its record has it then.
  void measure_comfort_of(FrameSlot& slot) const;
  /// Likewise.
  void measure_disparities_of(FrameSlot& slot) const;
  void pack_stereo_picture(FrameSlot& slot) const;
  [[nodiscard]] const Photograph* photograph_at(const FrameSlot& slot, double view_x) const;
  /// Null: the pair is rectified.
  [[nodiscard]] const Rectifier* rectifier_of(const FrameSlot& slot) const;
  /// Writes a depth map, a map of depth resolutions, a cloud or mesh to the slot's `encoded`.
  void encode_metric(FrameSlot& slot, const OutputStream& stream,
                     const std::filesystem::path& path) const;
  void encode_stream(FrameSlot& slot, const OutputStream& stream,
                     const std::filesystem::path& path) const;
  [[nodiscard]] std::string extension_of(const FrameSlot& slot, const OutputStream& stream) const;
  [[nodiscard]] const Photograph* stored_picture(const FrameSlot& slot,
                                                 const OutputStream& stream) const;
  [[nodiscard]] const Mask& mask_of(const FrameSlot& slot, const OutputStream& stream) const;

  const SequenceOptions& options_;
  const SequenceLayout& layout_;
  const PairSource& pairs_;
  std::optional<ImageExtent> frame_size_;
  const Rectifier* rectifier_;
  PairCameras* pair_cameras_;
  const RectifiedPair* cameras_;
  const MapCamera* map_camera_;
  const FramePoses* poses_;
  const ShotTable* shots_;
  Execution& execution_;
  StepAccounts& accounts_;
  ShotMatchers matchers_;
  PoseRenderer renderer_;
  std::optional<PhotographGrid> photograph_grid_;  ///< if views_show_photographs()
  bool videos_show_views_;
  /// Whether the files of a frame hold the maps that its pictures in videos are made from.
  bool maps_are_stored_;
  TemporalState temporal_;
  FrameReuse reuse_;
  int chunk_of_past_ = -1;  ///< chunk of temporal_ and reuse_
  mutable BusyClock compute_clock_;
  std::atomic<int> looks_beyond_ = 0;
};

}  // namespace vantage
