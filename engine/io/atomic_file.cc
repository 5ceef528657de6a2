#include "engine/io/atomic_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>

#include "engine/error.h"
#include "engine/io/file_descriptor.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& path, int error_number) {
  throw Error(fmt::format("cannot write {}: {}", path.string(),
                          std::generic_category().message(error_number)));
}

fs::path folder_of(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

/// Where the bytes of `path` lie: behind a link, not in its place.
fs::path resolve_links(const fs::path& path) {
  std::error_code ignored;
  const fs::path resolved = fs::canonical(path, ignored);
  return ignored ? path : resolved;
}

}  // namespace

AtomicFile::AtomicFile(const fs::path& path) : given_path_(path), final_path_(resolve_links(path)) {
  if (!path.has_filename()) {
    throw Error(fmt::format("cannot write '{}': expected a file name", path.string()));
  }
  std::error_code ignored;
  const fs::file_status status = fs::status(final_path_, ignored);
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    throw Error(fmt::format("cannot write {}: it is {}, expected a regular file or none",
                            path.string(),
                            fs::is_directory(status) ? "a folder" : "not a regular file"));
  }
  const fs::path folder = folder_of(final_path_);
  if (!fs::is_directory(folder, ignored)) {
    throw Error(
        fmt::format("cannot write {}: there is no folder {}", path.string(), folder.string()));
  }
  for (int attempt = 0;; ++attempt) {
    temporary_path_ = folder / fmt::format(".{}.tmp-{}-{}{}", final_path_.stem().string(),
                                           ::getpid(), attempt, final_path_.extension().string());
    const FileDescriptor file(
        ::open(temporary_path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
    if (file.valid()) {
      return;
    }
    if (errno != EEXIST) {
      fail(given_path_, errno);
    }
  }
}

AtomicFile::~AtomicFile() {
  if (!committed_) {
    std::error_code ignored;
    fs::remove(temporary_path_, ignored);
  }
}

void AtomicFile::commit() {
  {
    const FileDescriptor file(::open(temporary_path_.c_str(), O_RDONLY | O_CLOEXEC));
    if (!file.valid() || ::fsync(file.get()) != 0) {
      fail(given_path_, errno);
    }
  }
  if (::rename(temporary_path_.c_str(), final_path_.c_str()) != 0) {
    fail(given_path_, errno);
  }
  committed_ = true;
  // Makes the new name itself survive a power cut. Some file systems cannot do this for folders;
  // the file is complete either way.
  const FileDescriptor folder(
      ::open(folder_of(final_path_).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (folder.valid()) {
    (void)::fsync(folder.get());
  }
}

void write_binary_file(const fs::path& path, std::span<const std::uint8_t> bytes) {
  AtomicFile target(path);
  {
    const FileDescriptor file(::open(target.temporary_path().c_str(), O_WRONLY | O_CLOEXEC));
    if (!file.valid()) {
      fail(path, errno);
    }
    while (!bytes.empty()) {
      const ssize_t written = ::write(file.get(), bytes.data(), bytes.size());
      if (written < 0 && errno != EINTR) {
        fail(path, errno);
      }
      bytes = bytes.subspan(static_cast<std::size_t>(std::max<ssize_t>(written, 0)));
    }
  }
  target.commit();
}

void write_text_file(const fs::path& path, std::string_view text) {
  write_binary_file(path, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

}  // namespace vantage
