#include "engine/sequence/sequence_join.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <vector>

#include "engine/error.h"
#include "engine/io/video_join.h"
#include "engine/sequence/leftovers.h"

namespace vantage {
namespace {

/// Held while a process joins: several may find at one time that all frames are there.
class JoinLock {
 public:
  explicit JoinLock(const std::filesystem::path& journal_folder)
      : descriptor_(::open((journal_folder / "run.json").c_str(), O_RDWR | O_CLOEXEC)) {
    if (descriptor_ >= 0) {
      (void)::flock(descriptor_, LOCK_EX);
    }
  }
  JoinLock(const JoinLock&) = delete;
  JoinLock& operator=(const JoinLock&) = delete;
  ~JoinLock() {
    if (descriptor_ >= 0) {
      ::close(descriptor_);
    }
  }

 private:
  int descriptor_;
};

/// Segments that follow each other from the first of `frames` on.
std::vector<FrameRange> segments_of(const DeliveredFrames& delivered, FrameRange frames) {
  std::vector<FrameRange> chosen;
  int next = frames.first;
  for (const FrameRange segment : delivered.segments()) {
    if (segment.first == next && segment.end <= frames.end) {
      chosen.push_back(segment);
      next = segment.end;
    }
  }
  return chosen;
}

SoundTrack sound_of(const SequenceOptions& options, const RunIdentity& identity,
                    FrameRange frames) {
  if (!options.sound || identity.sound_file.empty() || identity.sound_rate != options.frame_rate) {
    return {};
  }
  const double rate = identity.sound_rate.per_second();
  return {identity.sound_file, (identity.sound_first_frame + frames.first) / rate,
          (identity.sound_first_frame + frames.end) / rate};
}

void join_videos_of(const SequenceOptions& options, const SequenceLayout& layout,
                    const SoundTrack& sound, const std::vector<FrameRange>& segments) {
  for (const OutputStream& stream : layout.streams()) {
    if (!stream.as_video) {
      continue;
    }
    std::vector<std::filesystem::path> paths;
    paths.reserve(segments.size());
    for (const FrameRange segment : segments) {
      paths.push_back(layout.segment(stream, segment));
    }
    remove_leftovers_of(layout.video(stream));
    join_videos(paths, options.frame_rate, sound, layout.video(stream));
  }
}

}  // namespace

FrameRange contiguous_frames(const DeliveredFrames& delivered, int frame_count) {
  if (delivered.records().empty()) {
    return {};
  }
  const FrameRange span{delivered.records().begin()->first,
                        std::min(frame_count, delivered.records().rbegin()->first + 1)};
  return delivered.missing(span).empty() ? span : FrameRange{};
}

void join_segments(const SequenceOptions& options, const SequenceLayout& layout,
                   const RunIdentity& identity, FrameRange frames, bool made_segments,
                   RunJournal& journal) {
  if (!layout.has_videos() || frames.empty()) {
    return;
  }
  const JoinLock lock(layout.journal_folder());
  const DeliveredFrames delivered(layout);
  const std::vector<FrameRange> segments = segments_of(delivered, frames);
  const int segments_end = segments.empty() ? frames.first : segments.back().end;
  const int end = delivered.input_end(frames);
  if (end == frames.first) {
    return;
  }
  const std::vector<int> skipped = delivered.skipped(frames);
  const bool is_complete = frames == FrameRange{0, identity.frame_count} && skipped.empty();
  const bool stays = delivered.joined() == frames && delivered.joined_skipped() == skipped &&
                     (!made_segments || (is_complete && segments_end < end));
  if (!stays) {
    if (segments_end < end) {
      throw Error(
          fmt::format("frame {} is of no video segment that begins where another ends, "
                      "expected segments of frames {}-{}; 'vantage run --resume' without --frames "
                      "makes them",
                      segments_end, frames.first, end - 1));
    }
    join_videos_of(options, layout, sound_of(options, identity, {frames.first, end}), segments);
    const JournalRecord joined = JoinRecord{frames, skipped};
    journal.append({&joined, 1});
  }
  if (is_complete) {
    std::error_code ignored;  // they do no harm
    std::filesystem::remove_all(layout.journal_folder() / "segments", ignored);
  }
}

FlickerSums total_flicker(const DeliveredFrames& delivered) {
  FlickerSums total;
  for (const auto& [frame, record] : delivered.records()) {
    if (record.flicker.frames > 0) {
      total.add(record.flicker);
    }
  }
  return total;
}

}  // namespace vantage
