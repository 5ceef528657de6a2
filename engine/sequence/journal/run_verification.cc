#include "engine/sequence/journal/run_verification.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <set>
#include <system_error>
#include <utility>

#include "engine/io/files/checksum.h"
#include "engine/sequence/journal/journal_content.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;

/// Files that should exist: files of frames, joined videos, reports, and existing segments.
std::set<std::string> expected_files(const JournalContent& journal, const fs::path& folder) {
  std::set<std::string> names;
  const auto add = [&](const std::vector<FileRecord>& files) {
    for (const FileRecord& file : files) {
      names.insert(file.name);
    }
  };
  for (const auto& [frame, record] : journal.frames) {
    add(record.files);
  }
  for (const JoinRecord& join : journal.joins) {
    add(join.files);
  }
  for (const ReportRecord& report : journal.reports) {
    add(report.files);
  }
  for (const SegmentRecord& segment : journal.segments) {
    std::error_code ignored;
    if (std::ranges::all_of(segment.files, [&](const FileRecord& file) {
          return fs::exists(folder / file.name, ignored);
        })) {
      add(segment.files);
    }
  }
  return names;
}

/// What is wrong with a file, or nothing. One of another size is not read: it may be huge.
std::string problem_of(const fs::path& path, const std::vector<FileContent>& recorded) {
  std::error_code error;
  if (!fs::exists(path, error)) {
    return "is missing";
  }
  const std::uintmax_t bytes = fs::is_regular_file(path, error) ? fs::file_size(path, error) : 0;
  if (std::ranges::find(recorded, bytes, &FileContent::bytes) == recorded.end()) {
    return fs::is_regular_file(path, error)
               ? fmt::format("has {} bytes, expected {}", bytes, recorded.back().bytes)
               : "is not a regular file";
  }
  const std::optional<FileContent> found = file_content(path);
  if (!found) {
    return "cannot be read";
  }
  return std::ranges::find(recorded, *found) != recorded.end() ? "" : "is not as it was written";
}

}  // namespace

RunVerification verify_run(const SequenceLayout& layout,
                           const std::function<void(int files_done, int files_total)>& on_progress,
                           const std::atomic<bool>* stop) {
  const JournalContent journal = read_journal(layout);
  RunVerification result;
  result.damaged_lines = journal.damaged_lines + journal.unlikely_records;
  const std::set<std::string> names = expected_files(journal, layout.folder());
  for (const std::string& name : names) {
    if (stop != nullptr && stop->load()) {
      result.interrupted = true;
      break;
    }
    const fs::path path = layout.folder() / name;
    const std::vector<FileContent>& recorded = journal.contents.at(name);
    std::string problem = problem_of(path, recorded);
    result.bytes += problem.empty() ? recorded.back().bytes : 0;
    if (!problem.empty()) {
      result.damaged.push_back({name, std::move(problem)});
    }
    ++result.files;
    on_progress(result.files, static_cast<int>(names.size()));
  }
  return result;
}

}  // namespace vantage
