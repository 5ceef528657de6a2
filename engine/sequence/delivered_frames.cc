#include "engine/sequence/delivered_frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>

namespace vantage {
namespace {

namespace fs = std::filesystem;

bool has_content(const fs::path& path) {
  std::error_code error;
  const auto bytes = fs::file_size(path, error);
  return !error && bytes > 0;
}

/// Whether all videos are there, whole or in this segment.
template <typename PathOf>
bool has_videos(const SequenceLayout& layout, const PathOf& path_of) {
  return std::ranges::all_of(layout.streams(), [&](const OutputStream& stream) {
    return !stream.as_video || has_content(path_of(stream));
  });
}

/// In order; those within another are left out.
std::vector<FrameRange> outermost(std::vector<FrameRange> ranges) {
  std::ranges::sort(ranges, [](FrameRange a, FrameRange b) {
    return a.first != b.first ? a.first < b.first : a.end > b.end;
  });
  std::vector<FrameRange> kept;
  for (const FrameRange range : ranges) {
    if (kept.empty() || !kept.back().contains(range)) {
      kept.push_back(range);
    }
  }
  return kept;
}

}  // namespace

DeliveredFrames::DeliveredFrames(const SequenceLayout& layout) {
  for (JournalRecord& record : RunJournal::read_records(layout.journal_folder())) {
    if (auto* frame = std::get_if<FrameRecord>(&record)) {
      // A skipped frame that has been repaired since is done, whichever part says so later.
      const auto known = records_.find(frame->frame);
      if (known == records_.end() || known->second.skipped || !frame->skipped) {
        records_[frame->frame] = std::move(*frame);
      }
    } else if (const auto* segment = std::get_if<SegmentRecord>(&record)) {
      segments_.push_back(segment->frames);
    } else {
      // Parts are read in no particular order; what was joined last is what was joined most of.
      const FrameRange frames = std::get<JoinRecord>(record).frames;
      joined_ = frames.count() > joined_.count() ? frames : joined_;
    }
  }
  if (!has_videos(layout, [&](const OutputStream& stream) { return layout.video(stream); })) {
    joined_ = {};
  }
  std::erase_if(segments_, [&](FrameRange frames) {
    return !has_videos(layout,
                       [&](const OutputStream& stream) { return layout.segment(stream, frames); });
  });
  segments_ = outermost(std::move(segments_));
  std::erase_if(records_, [&](const auto& entry) {
    const auto& [frame, record] = entry;
    const bool in_video =
        !layout.has_videos() || joined_.contains(frame) ||
        std::ranges::any_of(segments_, [&](FrameRange part) { return part.contains(frame); });
    return !in_video || !std::ranges::all_of(record.files, [&](const std::string& file) {
      return has_content(layout.folder() / file);
    });
  });
}

bool DeliveredFrames::is_done(int frame) const {
  const auto known = records_.find(frame);
  return known != records_.end() && !known->second.skipped;
}

std::vector<FrameRange> DeliveredFrames::missing(FrameRange frames) const {
  std::vector<FrameRange> ranges;
  int next = frames.first;
  const auto add_until = [&](int end) {
    if (next < end) {
      ranges.push_back({next, end});
    }
  };
  for (auto known = records_.lower_bound(frames.first);
       known != records_.end() && known->first < frames.end; ++known) {
    add_until(known->first);
    next = known->first + 1;
  }
  add_until(frames.end);
  return ranges;
}

std::string to_string(const std::vector<FrameRange>& ranges) {
  std::string text;
  for (const FrameRange range : ranges) {
    text += text.empty() ? "" : ", ";
    text += range.count() == 1 ? fmt::format("{}", range.first)
                               : fmt::format("{}-{}", range.first, range.end - 1);
  }
  return text;
}

}  // namespace vantage
