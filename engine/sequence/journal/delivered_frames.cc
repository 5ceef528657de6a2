#include "engine/sequence/journal/delivered_frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <system_error>
#include <utility>

#include "engine/io/files/checksum.h"
#include "engine/sequence/journal/journal_content.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;

bool is_whole(const fs::path& path, std::uintmax_t bytes) {
  std::error_code error;
  return bytes > 0 && fs::file_size(path, error) == bytes && !error;
}

/// In order, without segments inside another.
std::vector<FrameRange> outermost(const std::vector<SegmentRecord>& segments) {
  std::vector<FrameRange> ranges;
  for (const SegmentRecord& segment : segments) {
    ranges.push_back(segment.frames);
  }
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
  JournalContent journal = read_journal(layout);
  const auto are_there = [&](const std::vector<FileRecord>& files) {
    return std::ranges::all_of(files, [&](const FileRecord& file) {
      return is_whole(layout.folder() / file.name, file.content.bytes);
    });
  };
  // Parts are read in no particular order, so the join with the most frames counts as the last one;
  // for the same frames, the one with fewer skipped frames.
  const auto rank = [](const JoinRecord& joined) {
    return std::pair(joined.frames.count(), -static_cast<int>(joined.skipped.size()));
  };
  for (JoinRecord& join : journal.joins) {
    if (are_there(join.files) && rank(join) > rank(joined_)) {
      joined_ = std::move(join);
    }
  }
  // Joining gives their packets a new checksum, so what changed must not get that far.
  std::erase_if(journal.segments, [&](const SegmentRecord& segment) {
    return !are_there(segment.files) ||
           !std::ranges::all_of(segment.files, [&](const FileRecord& file) {
             return record_of_file(layout.folder(), file.name).content == file.content;
           });
  });
  segments_ = outermost(journal.segments);
  for (auto& [frame, record] : journal.frames) {
    if (!are_there(record.files)) {
      continue;
    }
    const bool in_video = !layout.has_videos() || record.absent || joined_.frames.contains(frame) ||
                          !segment_with(frame).empty();
    if (in_video || !record.files.empty()) {
      (in_video ? records_ : without_video_)[frame] = std::move(record);
    }
  }
}

bool DeliveredFrames::is_done(int frame) const {
  const auto known = records_.find(frame);
  return known != records_.end() && !known->second.skipped;
}

const FrameRecord* DeliveredFrames::files_of(int frame) const {
  for (const auto* records : {&records_, &without_video_}) {
    const auto known = records->find(frame);
    if (known != records->end()) {
      return known->second.files.empty() ? nullptr : &known->second;
    }
  }
  return nullptr;
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
  // None is within another: of those that start early enough, the last one ends last.
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

FrameRange input_frames(const RunIdentity& identity, const DeliveredFrames& delivered) {
  if (!identity.is_stream()) {
    return {0, identity.frame_count};
  }
  return {0, delivered.records().empty() ? 0 : delivered.records().rbegin()->first + 1};
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
