#include "engine/sequence/journal/sequence_join.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <system_error>
#include <utility>
#include <vector>

#include "engine/error.h"
#include "engine/io/files/file_descriptor.h"
#include "engine/io/files/temporary_name.h"
#include "engine/io/video/frame_rate.h"
#include "engine/io/video/writing/video_join.h"

namespace vantage {
namespace {

/// Consecutive segments from the first of `frames` on.
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

/// Empty: videos have a constant rate.
std::optional<FrameTimes> times_of(const SequenceOptions& options, const RunIdentity& identity,
                                   FrameRange frames) {
  const FrameTimes* times = identity.times_at(options.frame_rate);
  return times != nullptr ? std::optional(times->some(frames.first, frames.count())) : std::nullopt;
}

SoundTrack sound_of(const SequenceOptions& options, const RunIdentity& identity,
                    const std::optional<FrameTimes>& times, FrameRange frames) {
  if (!options.sound || identity.sound_file.empty() || identity.sound_rate != options.frame_rate) {
    return {};
  }
  if (times) {
    return {identity.sound_file, times->seconds(0), times->seconds(frames.count())};
  }
  const double rate = identity.sound_rate.per_second();
  return {identity.sound_file, (identity.sound_first_frame + frames.first) / rate,
          (identity.sound_first_frame + frames.end) / rate};
}

/// Returns why sound was left out, as join_videos() does.
std::string join_videos_of(const SequenceOptions& options, const SequenceLayout& layout,
                           const RunIdentity& identity, FrameRange frames,
                           const std::vector<FrameRange>& segments) {
  const std::optional<FrameTimes> times = times_of(options, identity, frames);
  const SoundTrack sound = sound_of(options, identity, times, frames);
  std::string sound_problem;
  for (const OutputStream& stream : layout.streams()) {
    if (!stream.as_video) {
      continue;
    }
    std::vector<std::filesystem::path> paths;
    paths.reserve(segments.size());
    for (const FrameRange segment : segments) {
      paths.push_back(layout.segment(stream, segment));
    }
    const std::string problem =
        join_videos(paths, options.frame_rate, sound, layout.video(stream), times);
    sound_problem = sound_problem.empty() ? problem : sound_problem;
  }
  return sound_problem;
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

std::string join_segments(const SequenceOptions& options, const SequenceLayout& layout,
                          const RunIdentity& identity, FrameRange frames, bool made_segments,
                          RunJournal& journal) {
  if (!layout.has_videos() || frames.empty()) {
    return "";
  }
  // Several processes may find at the same time that all frames exist.
  const FileLock lock(layout.journal_folder() / "run.json", FileLock::Wait::kYes);
  for (const OutputStream& stream : layout.streams()) {
    if (stream.as_video) {
      remove_temporary_files_of(layout.video(stream));
    }
  }
  const DeliveredFrames delivered(layout);
  const std::vector<FrameRange> segments = segments_of(delivered, frames);
  const int segments_end = segments.empty() ? frames.first : segments.back().end;
  const int end = delivered.input_end(frames);
  if (end == frames.first) {
    return "";
  }
  std::string sound_problem;
  const std::vector<int> skipped = delivered.skipped(frames);
  const bool is_complete =
      identity.is_stream() || (frames == FrameRange{0, identity.frame_count} && skipped.empty());
  const bool stays = delivered.joined() == frames && delivered.joined_skipped() == skipped &&
                     (!made_segments || (is_complete && segments_end < end));
  if (!stays) {
    if (segments_end < end) {
      throw Error(fmt::format(
          "frame {} is in no video segment that continues the one before, expected segments of "
          "frames {}-{}; `resume` without `frames` writes them",
          segments_end, frames.first, end - 1));
    }
    sound_problem = join_videos_of(options, layout, identity, {frames.first, end}, segments);
    JoinRecord joined{frames, skipped};
    for (const std::string& name : layout.video_names()) {
      joined.files.push_back(record_of_file(layout.folder(), name));
    }
    const JournalRecord record = std::move(joined);
    journal.append({&record, 1});
  }
  if (is_complete) {
    std::error_code ignored;  // remaining files do no harm
    std::filesystem::remove_all(layout.journal_folder() / "segments", ignored);
  }
  return sound_problem;
}

}  // namespace vantage
