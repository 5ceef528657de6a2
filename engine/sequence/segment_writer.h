#pragma once

#include <memory>
#include <vector>

#include "engine/io/video/video_io.h"
#include "engine/sequence/options/sequence_layout.h"
#include "engine/sequence/pairs/frame_range.h"
#include "engine/sequence/steps/frame_slot.h"

namespace vantage {

/// Writes the videos of a run, segment by segment. A segment has one picture for each input frame,
/// so that video frames correspond to input frames: a skipped frame shows the one before it, at the
/// start of a segment the next good one, and in a segment without good frames black.
///
/// Thread rule: one thread at a time.
class SegmentWriter {
 public:
  /// `frame_size`: of the pairs. All must outlive the writer.
  SegmentWriter(const SequenceOptions& options, const SequenceLayout& layout,
                ImageExtent frame_size, Execution& execution);
  ~SegmentWriter();

  /// Starts the segment of `frames`; an unfinished segment is dropped.
  void begin(FrameRange frames);
  /// The next frame of the segment. Throws OutputError.
  void add(const FrameSlot& slot);
  void add_skipped();
  /// The videos of the segment, completely encoded: finish() then only waits for the disk.
  /// `frames`: those that have been added, which are the first ones of the segment if the input
  /// ended. Empty if the input has none of them. Throws OutputError.
  [[nodiscard]] std::vector<std::unique_ptr<VideoWriter>> end(FrameRange frames);

 private:
  struct Stream;
  void write(Stream& stream, const Photograph& picture, int times);
  [[nodiscard]] Photograph black_picture(const OutputStream& output) const;

  const SequenceOptions& options_;
  const SequenceLayout& layout_;
  ImageExtent frame_size_;
  Execution& execution_;
  std::vector<Stream> streams_;
  FrameRange frames_;
};

}  // namespace vantage
