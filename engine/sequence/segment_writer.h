#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include "engine/io/video/video_io.h"
#include "engine/sequence/options/sequence_layout.h"
#include "engine/sequence/pairs/frame_range.h"
#include "engine/sequence/steps/frame_slot.h"

namespace vantage {

/// Writes the videos of a run, segment by segment. A segment has one picture for each input frame,
/// so that video frames correspond to input frames: a skipped frame shows the one before it, at the
/// start of a segment the next good one, and in a segment without good frames black. Pictures wait,
/// converted, until some thread encodes them.
///
/// Thread rule: one thread at a time; encode_some() by any.
class SegmentWriter {
 public:
  /// `frame_size`: of the pairs. `max_waiting`: frames of a video; who adds more encodes itself.
  /// The others must outlive the writer.
  SegmentWriter(const SequenceOptions& options, const SequenceLayout& layout,
                ImageExtent frame_size, int max_waiting);
  ~SegmentWriter();

  /// Starts the segment of `frames`; an unfinished segment is dropped.
  void begin(FrameRange frames);
  /// The next frame of the segment, whose pictures it takes. Throws OutputError.
  void add(FrameSlot& slot);
  void add_skipped();
  /// VideoWriter::encode_some() of the first video, also of segments that have ended, that has work
  /// for another thread; false where none has.
  bool encode_some();
  /// The videos of the segment, which have all their frames.
  /// `frames`: those that have been added, which are the first ones of the segment if the input
  /// ended. Empty if the input has none of them. Throws OutputError.
  [[nodiscard]] std::vector<std::shared_ptr<VideoWriter>> end(FrameRange frames);

 private:
  struct Stream;
  void write(Stream& stream, int times);
  [[nodiscard]] Photograph black_picture(const OutputStream& output) const;

  const SequenceOptions& options_;
  const SequenceLayout& layout_;
  ImageExtent frame_size_;
  int max_waiting_;
  std::vector<Stream> streams_;
  FrameRange frames_;
  std::mutex mutex_;
  std::vector<std::weak_ptr<VideoWriter>> writers_;  ///< guarded by it; of all segments
};

}  // namespace vantage
