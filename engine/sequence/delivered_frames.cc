#include "engine/sequence/delivered_frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <system_error>
#include <utility>

namespace vantage {
namespace {

namespace fs = std::filesystem;

bool has_content(const fs::path& path) {
  std::error_code error;
  const auto bytes = fs::file_size(path, error);
  return !error && bytes > 0;
}

bool is_whole(const fs::path& path, std::uintmax_t bytes) {
  std::error_code error;
  return bytes > 0 && fs::file_size(path, error) == bytes && !error;
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
      // Of the same frames the one with fewer skipped ones.
      auto& join = std::get<JoinRecord>(record);
      const auto rank = [](const JoinRecord& joined) {
        return std::pair(joined.frames.count(), -static_cast<int>(joined.skipped.size()));
      };
      if (rank(join) > rank(joined_)) {
        joined_ = std::move(join);
      }
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
    const bool in_video = !layout.has_videos() || record.absent || joined_.frames.contains(frame) ||
                          !segment_with(frame).empty();
    return !in_video || !std::ranges::all_of(record.files, [&](const FileRecord& file) {
      return is_whole(layout.folder() / file.name, file.bytes);
    });
  });
}

bool DeliveredFrames::is_done(int frame) const {
  const auto known = records_.find(frame);
  return known != records_.end() && !known->second.skipped;
}

std::vector<int> DeliveredFrames::skipped(FrameRange frames) const {
  std::vector<int> skipped;
  for (const auto& [frame, record] : records_) {
    if (record.skipped && frames.contains(frame)) {
      skipped.push_back(frame);
    }
  }
  return skipped;
}

FrameRange DeliveredFrames::segment_with(int frame) const {
  // None is within another: the last one that begins early enough ends last.
  const auto next = std::ranges::upper_bound(segments_, frame, {}, &FrameRange::first);
  const bool is_found = next != segments_.begin() && std::prev(next)->contains(frame);
  return is_found ? *std::prev(next) : FrameRange{};
}

int DeliveredFrames::input_end(FrameRange frames) const {
  int end = frames.end;
  for (auto known = records_.find(end - 1);
       end > frames.first && known != records_.end() && known->second.absent;
       known = records_.find(end - 1)) {
    --end;
  }
  return end;
}

bool DeliveredFrames::is_in_one_piece(FrameRange frames) const {
  return joined_.frames.contains(frames) || segment_with(frames.first).contains(frames) ||
         input_end(frames) == frames.first;
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
