#include "engine/sequence/journal/pending_files.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <string>
#include <system_error>

#include "engine/io/files/file_descriptor.h"
#include "engine/io/files/temporary_name.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& path, int error_number) {
  throw OutputError(fmt::format("cannot write {}: {}", path.string(),
                                std::generic_category().message(error_number)));
}

}  // namespace

PendingFiles& PendingFiles::operator=(PendingFiles&& other) noexcept {
  discard();
  files_.swap(other.files_);
  return *this;
}

void PendingFiles::add(const fs::path& path, std::span<const std::uint8_t> bytes) {
  // A name unique to this process: a requeued job may start while the previous one is still ending.
  const fs::path hidden = path.parent_path() / temporary_name(path, 0);
  files_.push_back({.hidden = hidden, .path = path});
  FileDescriptor file(::open(hidden.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666));
  if (!file.valid() || !write_all(file.get(), bytes)) {
    fail(path, errno);
  }
  // Starts writing early, so that flushing takes less time. If this fails, flushing does it all.
  (void)::sync_file_range(file.get(), 0, 0, SYNC_FILE_RANGE_WRITE);
  if (!file.close()) {
    fail(path, errno);
  }
}

void PendingFiles::flush(std::size_t index) noexcept {
  File& file = files_[index];
  const FileDescriptor written(::open(file.hidden.c_str(), O_RDONLY | O_CLOEXEC));
  const bool is_safe = written.valid() && ::fsync(written.get()) == 0;
  file.flush_error = is_safe ? 0 : errno;
  if (is_safe) {
    // Frees the pages for the next files: otherwise a long run fills the memory with results, and
    // the system must search for pages to reclaim.
    (void)::posix_fadvise(written.get(), 0, 0, POSIX_FADV_DONTNEED);
  }
  file.is_flushed = true;
}

void PendingFiles::commit(std::set<fs::path>& folders) {
  for (std::size_t index = 0; index < files_.size(); ++index) {
    const File& file = files_[index];
    if (!file.is_flushed) {
      flush(index);
    }
    if (file.flush_error != 0) {
      fail(file.path, file.flush_error);
    }
    if (::rename(file.hidden.c_str(), file.path.c_str()) != 0) {
      fail(file.path, errno);
    }
    folders.insert(file.path.parent_path());
  }
  files_.clear();
}

void PendingFiles::discard() noexcept {
  for (const File& file : files_) {
    std::error_code ignored;
    fs::remove(file.hidden, ignored);
  }
  files_.clear();
}

}  // namespace vantage
