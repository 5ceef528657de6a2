#include "apps/batch/result_mirror.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <variant>
#include <vector>

#include "apps/process/scratch_folder.h"
#include "engine/error.h"
#include "engine/io/files/atomic_file.h"
#include "engine/io/files/checksum.h"
#include "engine/sequence/journal/journal_content.h"
#include "engine/sequence/journal/run_journal.h"

namespace vantage::apps {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kJournal = ".vantage/";
constexpr std::string_view kSegments = ".vantage/segments/";
constexpr std::uint64_t kMaxBytes = 1ULL << 40;

/// Frees the disk, and keeps the size, by which a run knows that a file is done.
void empty_file(const fs::path& file, std::uint64_t bytes) {
  std::error_code ignored;
  fs::resize_file(file, 0, ignored);
  fs::resize_file(file, bytes, ignored);
}

bool is_in_any(const std::vector<FrameRange>& ranges, int frame) {
  return std::ranges::any_of(ranges, [frame](FrameRange range) { return range.contains(frame); });
}

}  // namespace

void put_result(ObjectStore& store, const std::string& key, const fs::path& file,
                const FileContent& content) {
  if (store.put_file(key, file, {.if_absent = true})) {
    return;
  }
  const ObjectPart there = store.read(key, std::nullopt, "", kMaxBytes);
  if (FileContent{there.bytes.size(), crc32_of(there.bytes)} != content) {
    throw Error(fmt::format("{}: is there already, and this batch did not make it", key));
  }
}

ResultMirror::ResultMirror(ObjectStore& store, std::string prefix, const SequenceLayout& layout,
                           std::string part)
    : store_(store), prefix_(std::move(prefix)), layout_(layout), part_(std::move(part)) {}

void ResultMirror::fetch_file(const std::string& name) {
  const ObjectPart object = store_.read(prefix_ + name, std::nullopt, "", kMaxBytes);
  make_folder((layout_.folder() / name).parent_path());
  write_binary_file(layout_.folder() / name, object.bytes);
}

void ResultMirror::fetch() {
  std::vector<std::string> names;
  std::set<std::string> segments;
  store_.list(prefix_ + std::string(kJournal), false, [&](const ListedObject& object) {
    const std::string name = object.key.substr(prefix_.size());
    const bool is_of_other_part = !part_.empty() && name.find("/frames-") != std::string::npos &&
                                  !name.ends_with("/frames-" + part_ + ".jsonl");
    if (name.starts_with(kSegments)) {
      segments.insert(name);
    } else if (!is_of_other_part) {
      names.push_back(name);
    }
    return true;
  });
  if (names.empty()) {
    return;
  }
  std::ranges::for_each(names, [&](const std::string& name) { fetch_file(name); });
  const JournalContent journal = read_journal(layout_);
  std::vector<FrameRange> in_videos;
  for (const JoinRecord& join : journal.joins) {
    const bool is_there = std::ranges::all_of(join.files, [&](const FileRecord& file) {
      return store_.info(prefix_ + file.name).has_value();
    });
    if (is_there) {
      in_videos.push_back(join.frames);
      std::ranges::for_each(join.files, [&](const FileRecord& file) { stand_in_for(file); });
    }
  }
  for (const SegmentRecord& segment : journal.segments) {
    const bool is_there = std::ranges::all_of(
        segment.files, [&](const FileRecord& file) { return segments.contains(file.name); });
    if (is_there && !is_in_any(in_videos, segment.frames.first)) {
      in_videos.push_back(segment.frames);
      for (const FileRecord& file : segment.files) {
        fetch_file(file.name);
        kept_.insert(file.name);
      }
    }
  }
  for (const auto& [frame, record] : journal.frames) {
    // Frames that are in no video yet are made again, from what they are made of.
    const bool is_done = !layout_.has_videos() || is_in_any(in_videos, frame);
    if (is_done) {
      std::ranges::for_each(record.files, [&](const FileRecord& file) { stand_in_for(file); });
    }
  }
}

void ResultMirror::stand_in_for(const FileRecord& file) {
  const fs::path place = layout_.folder() / file.name;
  make_folder(place.parent_path());
  write_text_file(place, "");
  empty_file(place, file.content.bytes);
  kept_.insert(file.name);
}

std::vector<std::string> ResultMirror::journal_files() const {
  std::vector<std::string> names;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(layout_.journal_folder(), ignored)) {
    const std::string name = entry.path().filename().string();
    if (entry.is_regular_file() && !name.starts_with('.')) {
      names.push_back(name);
    }
  }
  return names;
}

void ResultMirror::keep_file(const std::string& name, const FileContent& content,
                             bool is_of_frame) {
  const fs::path file = layout_.folder() / name;
  std::error_code ignored;
  if (kept_.contains(name) || !fs::exists(file, ignored)) {
    return;  // a segment that has been joined, say
  }
  put_result(store_, prefix_ + name, file, content);
  kept_.insert(name);
  if (is_of_frame) {
    empty_file(file, content.bytes);
  }
}

void ResultMirror::keep() {
  if (!RunJournal::is_present(layout_.journal_folder())) {
    return;
  }
  // The journal grows meanwhile; what is stored tells of files that are stored.
  const ScratchFolder snapshot(layout_.folder());
  for (const std::string& name : journal_files()) {
    fs::copy_file(layout_.journal_folder() / name, snapshot.path() / name);
  }
  for (const JournalRecord& record : RunJournal::read_records(snapshot.path()).records) {
    std::visit(
        [&]<typename Record>(const Record& one) {
          for (const FileRecord& file : one.files) {
            keep_file(file.name, file.content, std::is_same_v<Record, FrameRecord>);
          }
        },
        record);
  }
  for (const std::string& name : journal_files()) {
    if (fs::exists(snapshot.path() / name)) {
      (void)store_.put_file(prefix_ + std::string(kJournal) + name, snapshot.path() / name, {});
    }
  }
}

void ResultMirror::finish() {
  keep();
  if (!part_.empty()) {
    return;  // others still need what is not here
  }
  std::vector<std::string> keys;
  store_.list(prefix_ + std::string(kSegments), false, [&](const ListedObject& object) {
    const fs::path here = layout_.folder() / object.key.substr(prefix_.size());
    std::error_code ignored;
    if (!fs::exists(here, ignored)) {
      keys.push_back(object.key);
    }
    return true;
  });
  std::ranges::for_each(keys, [&](const std::string& key) { store_.remove(key); });
}

}  // namespace vantage::apps
