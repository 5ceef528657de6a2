#include "engine/sequence/journal/journal_content.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

namespace vantage {
namespace {

std::vector<std::string> sorted_names(const std::vector<FileRecord>& files) {
  std::vector<std::string> names;
  for (const FileRecord& file : files) {
    names.push_back(file.name);
  }
  std::ranges::sort(names);
  return names;
}

bool has_names(const std::vector<FileRecord>& files, std::vector<std::string> names) {
  std::ranges::sort(names);
  return sorted_names(files) == names;
}

bool is_likely(const FrameRecord& record, const SequenceLayout& layout) {
  if (record.name.find('/') != std::string::npos) {
    return false;
  }
  std::vector<std::string> begins;  // the format of a file depends on the frame
  if (!record.skipped && !record.absent) {
    for (const OutputStream& stream : layout.streams()) {
      if (!stream.as_video) {
        begins.push_back(SequenceLayout::file(stream, record.frame, record.name, "").string());
      }
    }
  }
  std::ranges::sort(begins);
  return std::ranges::equal(sorted_names(record.files), begins,
                            [](const std::string& name, const std::string& begin) {
                              return name.starts_with(begin) && name.size() > begin.size() &&
                                     name.find('/', begin.size()) == std::string::npos;
                            });
}

bool is_likely(const SegmentRecord& record, const SequenceLayout& layout) {
  return has_names(record.files, layout.segment_names(record.frames));
}

bool is_likely(const JoinRecord& record, const SequenceLayout& layout) {
  return has_names(record.files, layout.video_names());
}

bool is_likely(const ReportRecord& record, const SequenceLayout& layout) {
  const std::vector<std::string> known = layout.report_names();
  return std::ranges::all_of(record.files, [&](const FileRecord& file) {
    return std::ranges::find(known, file.name) != known.end();
  });
}

void add(JournalContent& content, FrameRecord record) {
  // A skipped frame that has been repaired is done, whichever part says so later.
  const auto known = content.frames.find(record.frame);
  if (known == content.frames.end() || known->second.skipped || !record.skipped) {
    content.frames[record.frame] = std::move(record);
  }
}

void add(JournalContent& content, SegmentRecord record) {
  content.segments.push_back(std::move(record));
}

void add(JournalContent& content, JoinRecord record) { content.joins.push_back(std::move(record)); }

void add(JournalContent& content, ReportRecord record) {
  content.reports.push_back(std::move(record));
}

}  // namespace

JournalContent read_journal(const SequenceLayout& layout) {
  JournalContent content;
  JournalRecords records = RunJournal::read_records(layout.journal_folder());
  content.damaged_lines = records.damaged_lines;
  for (JournalRecord& record : records.records) {
    std::visit(
        [&](auto& one) {
          if (is_likely(one, layout)) {
            for (const FileRecord& file : one.files) {
              content.contents[file.name].push_back(file.content);
            }
            add(content, std::move(one));
          } else {
            ++content.unlikely_records;
          }
        },
        record);
  }
  return content;
}

}  // namespace vantage
