#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "engine/execution.h"
#include "engine/matching/stereo_matcher.h"
#include "engine/rectification/rectifier.h"
#include "engine/sequence/busy_clock.h"
#include "engine/sequence/frame_slot.h"
#include "engine/sequence/pair_source.h"
#include "engine/sequence/sequence_layout.h"
#include "engine/sequence/sequence_options.h"
#include "engine/sequence/shots.h"
#include "engine/sequence/temporal_state.h"
#include "engine/synthesis/photograph_grid.h"
#include "engine/synthesis/pose_renderer.h"

namespace vantage {

/// Size of a new view of images of size `images`: that of its cameras if they have one.
ImageExtent extent_of(const ViewPath& view, ImageExtent images);

/// Whether the views of frames that are rectified take their colours from the photographs as they
/// were read. The book's warp moves pixels of rectified images.
bool views_show_photographs(const SequenceOptions& options);

/// What frames are worked on with. All must outlive the worker.
struct FrameTools {
  const SequenceOptions& options;
  const SequenceLayout& layout;
  const PairSource& pairs;                ///< for decoding
  std::optional<ImageExtent> frame_size;  ///< that all frames must have; empty: any
  const Rectifier* rectifier;             ///< null: the pairs are rectified
  const RectifiedPair* cameras;           ///< of the pairs; null unless a view needs them
  const ShotTable* shots;                 ///< null unless the options need shots
  Execution& execution;
};

/// The steps of a frame between reading and writing. What they do depends on the frame and, with a
/// temporal prior, on the frames before it in its chunk.
class FrameWorker {
 public:
  explicit FrameWorker(const FrameTools& tools);

  /// Whether compute() must be called in the order of the frames, one after the other.
  [[nodiscard]] bool computes_in_order() const { return options_.temporal.weight > 0; }

  /// Decodes and rectifies. Thread rule: concurrently for different slots; so encode(), and
  /// compute() unless computes_in_order().
  void prepare(FrameSlot& slot) const;
  /// Maps, new views, pictures; of a frame that is stored, what videos show. Its maps are read
  /// where all that is needed is in files that are as they were written; a file that is not makes
  /// it a frame that is not stored. Throws Error where the images do not fit.
  void compute(FrameSlot& slot);
  /// Writes the files of a frame that is neither a lead-in nor stored, without their names. Throws
  /// OutputError.
  void encode(FrameSlot& slot) const;

  /// Time during which at least one frame was in compute(), or rectified.
  [[nodiscard]] double compute_seconds() const { return compute_clock_.seconds(); }

  /// Of matching; see StereoMatcher.
  void add_memory_use(MemoryUse& use) const { matcher_.add_memory_use(use); }

  /// Of the reference's map.
  [[nodiscard]] const DisparityMap& primary_map(const FrameSlot& slot) const;
  /// Copies what `stream`, none of floats, shows of the frame to `picture`, whose memory is reused.
  void copy_picture(const FrameSlot& slot, const OutputStream& stream, Photograph& picture) const;

 private:
  void match(FrameSlot& slot);
  /// The frame is no longer stored when a file is not as it was written.
  void read_maps(FrameSlot& slot) const;
  /// Whether something that is made of the frame needs new views.
  [[nodiscard]] bool needs_views(const FrameSlot& slot) const;
  [[nodiscard]] bool wants(const FrameSlot& slot, SequenceOutput output) const;
  void synthesize(FrameSlot& slot) const;
  void paint_preview(FrameSlot& slot) const;
  void pack_stereo_picture(FrameSlot& slot) const;
  [[nodiscard]] const Photograph* photograph_at(const FrameSlot& slot, double view_x) const;
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
  const RectifiedPair* cameras_;
  const ShotTable* shots_;
  Execution& execution_;
  StereoMatcher matcher_;
  PoseRenderer renderer_;
  std::optional<PhotographGrid> photograph_grid_;  ///< where views_show_photographs()
  bool videos_show_views_;
  /// Whether the files of a frame hold the maps that its pictures in videos are made of.
  bool maps_are_stored_;
  TemporalState temporal_;
  int temporal_chunk_ = -1;  ///< that temporal_ is of
  mutable BusyClock compute_clock_;
};

}  // namespace vantage
