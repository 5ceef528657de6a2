#include "engine/sequence/journal/run_journal.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <deque>
#include <system_error>
#include <utility>

#include "engine/error.h"
#include "engine/io/files/atomic_file.h"
#include "engine/io/files/file_bytes.h"
#include "engine/io/files/file_descriptor.h"
#include "engine/sequence/journal/journal_json.h"
#include "engine/sequence/options/sequence_layout.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;

constexpr const char* kIdentityFile = "run.json";
constexpr std::string_view kPartBegin = "frames-";
constexpr std::string_view kPartEnd = ".jsonl";

std::string system_message(int error_number) {
  return std::generic_category().message(error_number);
}

std::span<const std::uint8_t> bytes_of(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

bool is_journal_of_part(const fs::path& path) {
  const std::string name = path.filename().string();
  return name.starts_with(kPartBegin) && name.ends_with(kPartEnd);
}

bool lock(int descriptor) {
  // File systems without locks are accepted.
  return ::flock(descriptor, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK;
}

/// All entries of `folder` except the run's description, in order.
std::vector<fs::path> entries_of(const fs::path& folder) {
  std::vector<fs::path> entries;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    if (entry->path().filename() != kIdentityFile) {
      entries.push_back(entry->path());
    }
  }
  if (error && error != std::errc::no_such_file_or_directory) {
    throw Error(fmt::format("{}: cannot be read: {}", folder.string(), error.message()));
  }
  std::ranges::sort(entries);
  return entries;
}

/// Removes a file or a folder with its content, if it exists.
void remove_whole(const fs::path& path) {
  std::error_code error;
  fs::remove_all(path, error);
  if (error) {
    throw Error(fmt::format("{}: cannot be removed: {}", path.string(), error.message()));
  }
}

/// Begins the run anew in a folder with records of another one. A description says first that they
/// do not count, so that whatever interrupts this leaves one run or the other. Throws when a
/// process works on a part of the run.
void replace_run(const fs::path& folder, RunIdentity identity) {
  const std::vector<fs::path> entries = entries_of(folder);
  std::deque<FileDescriptor> locks;  // held until all is removed
  for (const fs::path& path : entries) {
    if (!is_journal_of_part(path)) {
      continue;
    }
    const FileDescriptor& part = locks.emplace_back(::open(path.c_str(), O_RDWR | O_CLOEXEC));
    if (part.valid() && !lock(part.get())) {
      throw Error(fmt::format("{}: another process is working on this run ({}), expected none",
                              folder.parent_path().string(), path.filename().string()));
    }
  }
  identity.replaces_records = true;
  write_text_file(folder / kIdentityFile, text_of(identity));
  std::ranges::for_each(entries, remove_whole);
  flush_folder(folder);
  identity.replaces_records = false;
  write_text_file(folder / kIdentityFile, text_of(identity));
}

bool has_records(const fs::path& folder) {
  return std::ranges::any_of(entries_of(folder), is_journal_of_part);
}

/// Throws when there are records without a description of the run: they may come from other
/// settings.
void require_description(const fs::path& folder) {
  // In this order, because a new run is described first.
  if (has_records(folder) && !RunJournal::is_present(folder)) {
    throw Error(
        fmt::format("{} has records of a run but no {}, expected both; `overwrite` starts again",
                    folder.string(), kIdentityFile));
  }
}

/// The complete lines of a file, and their size in bytes. Throws Error: unreadable lines must not
/// be taken for missing ones.
std::pair<std::vector<std::string>, std::uintmax_t> whole_lines(const fs::path& path) {
  const std::string text = read_file_text(path, true);
  std::vector<std::string> lines;
  std::size_t begin = 0;
  for (std::size_t end = text.find('\n'); end != std::string::npos; end = text.find('\n', begin)) {
    lines.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return {std::move(lines), begin};
}

}  // namespace

struct RunJournal::State {
  /// Space reserved ahead, so that finished frames can be recorded although the disk is full.
  static constexpr off_t kReservedBytes = off_t{64} << 10;

  fs::path path;
  int descriptor = -1;
  off_t bytes = 0;
  off_t reserved_end = 0;

  State() = default;
  State(const State&) = delete;
  State& operator=(const State&) = delete;
  ~State() {
    if (reserved_end > 0) {
      (void)!::ftruncate(descriptor, bytes);  // releases the reserved space
    }
    if (descriptor >= 0) {
      ::close(descriptor);
    }
  }
  /// False when the disk is full. File systems that cannot reserve space are accepted.
  bool reserve() {
    if (reserved_end - bytes > kReservedBytes / 2) {
      return true;
    }
    if (::fallocate(descriptor, FALLOC_FL_KEEP_SIZE, bytes, kReservedBytes) != 0) {
      return errno != ENOSPC;
    }
    reserved_end = bytes + kReservedBytes;
    return true;
  }
};

RunJournal::RunJournal(const fs::path& journal_folder, const RunIdentity& identity,
                       JournalOpening opening, const std::string& part)
    : state_(std::make_unique<State>()) {
  const fs::path folder = journal_folder.parent_path();
  if (opening == JournalOpening::kOverwrite &&
      (is_present(journal_folder) || has_records(journal_folder))) {
    replace_run(journal_folder, identity);
  }
  make_folder(journal_folder);
  if (opening != JournalOpening::kForce) {
    require_description(journal_folder);
  }
  state_->path = journal_folder / fmt::format("{}{}{}", kPartBegin, part, kPartEnd);
  const bool is_new = create_text_file(journal_folder / kIdentityFile, text_of(identity));
  if (!is_new) {
    if (opening == JournalOpening::kNew && (part == "all" || fs::exists(state_->path))) {
      throw Error(fmt::format("{} already holds a run, expected {}`overwrite` to start again",
                              folder.string(),
                              identity.is_stream() ? "" : "`resume` to continue it or "));
    }
    const RunIdentity known = read_identity(journal_folder);
    const std::string differs = difference(known, identity);
    if (!differs.empty()) {
      if (opening != JournalOpening::kForce) {
        throw Error(
            fmt::format("{} holds a different run: {}; expected the same, `force` to continue "
                        "anyway or `overwrite` to start again",
                        folder.string(), differs));
      }
      remove_whole(journal_folder / kShotsFile);  // of the other inputs or settings
      write_text_file(journal_folder / kIdentityFile, text_of(identity));
    }
    if (known.replaces_records) {
      replace_run(journal_folder, identity);
    }
  }
  state_->descriptor = ::open(state_->path.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (state_->descriptor < 0) {
    fail_to_write(state_->path, errno);
  }
  struct stat status {};
  // A file without a name was removed by a process that starts the run again.
  if (!lock(state_->descriptor) || ::fstat(state_->descriptor, &status) != 0 ||
      status.st_nlink == 0) {
    throw Error(fmt::format("{}: another process is working on this part of the run ({})",
                            folder.string(), part));
  }
  flush_folder(journal_folder);  // the names of the two files
  // A line truncated by a crash must not run into the next one.
  state_->bytes = static_cast<off_t>(whole_lines(state_->path).second);
  if (::ftruncate(state_->descriptor, state_->bytes) != 0 || !state_->reserve()) {
    fail_to_write(state_->path, errno);
  }
}

RunJournal::RunJournal(RunJournal&&) noexcept = default;

RunJournal::~RunJournal() = default;

void RunJournal::append(std::span<const JournalRecord> records) {
  std::string text;
  for (const JournalRecord& record : records) {
    text += line_of(record);
  }
  if (!write_all(state_->descriptor, bytes_of(text))) {
    fail_to_write(state_->path, errno);
  }
  state_->bytes += static_cast<off_t>(text.size());
  (void)state_->reserve();
  if (::fdatasync(state_->descriptor) != 0) {
    fail_to_write(state_->path, errno);
  }
}

bool RunJournal::is_present(const fs::path& journal_folder) {
  std::error_code ignored;
  return fs::exists(journal_folder / kIdentityFile, ignored);
}

RunIdentity RunJournal::read_identity(const fs::path& journal_folder) {
  const fs::path path = journal_folder / kIdentityFile;
  if (!is_present(journal_folder)) {
    throw Error(fmt::format("{} holds no run: {} is missing", journal_folder.parent_path().string(),
                            path.string()));
  }
  return identity_of(read_file_text(path, true), path);
}

std::vector<std::string> RunJournal::parts(const fs::path& journal_folder) {
  std::vector<std::string> parts;
  for (const fs::path& file : entries_of(journal_folder)) {
    if (is_journal_of_part(file)) {
      const std::string name = file.filename().string();
      parts.push_back(
          name.substr(kPartBegin.size(), name.size() - kPartBegin.size() - kPartEnd.size()));
    }
  }
  return parts;
}

JournalRecords RunJournal::read_records(const fs::path& journal_folder) {
  JournalRecords all;
  if (is_present(journal_folder) && read_identity(journal_folder).replaces_records) {
    return all;
  }
  for (const fs::path& file : entries_of(journal_folder)) {
    if (!is_journal_of_part(file)) {
      continue;
    }
    for (const std::string& line : whole_lines(file).first) {
      if (std::optional<JournalRecord> record = record_of(line)) {
        all.records.push_back(std::move(*record));
      } else {
        ++all.damaged_lines;  // the frame counts as not done and is computed again
      }
    }
  }
  return all;
}

FileRecord record_of_file(const fs::path& folder, const std::string& name) {
  const std::optional<FileContent> content = file_content(folder / name);
  if (!content) {
    throw Error(fmt::format("cannot read {}: {}", (folder / name).string(), system_message(errno)));
  }
  return {name, *content};
}

}  // namespace vantage
