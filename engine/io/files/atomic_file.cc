#include "engine/io/files/atomic_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "engine/error.h"
#include "engine/io/files/file_descriptor.h"
#include "engine/io/files/remote_files.h"
#include "engine/io/files/temporary_name.h"
#include "engine/io/files/unfinished_files.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;

fs::path folder_of(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

std::span<const std::uint8_t> bytes_of(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

/// Writes the existing file `target`; messages name `path`.
void fill(const fs::path& target, std::span<const std::uint8_t> bytes, const fs::path& path) {
  // Created again if another process has removed it.
  FileDescriptor file(::open(target.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666));
  if (!file.valid() || !write_all(file.get(), bytes) || !file.close()) {
    fail_to_write(path, errno);
  }
}

}  // namespace

AtomicFile::AtomicFile(const fs::path& path) : given_path_(path), final_path_(through_links(path)) {
  if (!path.has_filename()) {
    throw Error(fmt::format("cannot write '{}': expected a file name", path.string()));
  }
  if (is_address(path)) {
    std::error_code error;
    const fs::path temporary = fs::temp_directory_path(error);
    if (error) {
      throw Error(fmt::format("cannot write {}: TMPDIR is no folder, expected one for its file",
                              path.string()));
    }
    create_temporary(temporary);
    return;
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
  create_temporary(folder);
}

void AtomicFile::create_temporary(const fs::path& folder) {
  for (int attempt = 0;; ++attempt) {
    temporary_path_ = folder / temporary_name(final_path_, attempt);
    note_unfinished(temporary_path_);
    const FileDescriptor file(
        ::open(temporary_path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
    if (file.valid()) {
      return;
    }
    const int error = errno;
    forget_unfinished(temporary_path_);
    if (error != EEXIST) {
      fail_to_write(given_path_, error);
    }
  }
}

AtomicFile::~AtomicFile() {
  if (!committed_) {
    std::error_code ignored;
    fs::remove(temporary_path_, ignored);
    forget_unfinished(temporary_path_);
  }
}

int AtomicFile::flush() const {
  const FileDescriptor file(::open(temporary_path_.c_str(), O_RDONLY | O_CLOEXEC));
  return file.valid() && ::fsync(file.get()) == 0 ? 0 : errno;
}

void AtomicFile::flush_name() const {
  // Makes the new name itself durable.
  flush_folder(folder_of(final_path_));
}

void AtomicFile::commit() {
  if (is_address(final_path_)) {
    (void)remote_files(final_path_).write(final_path_.string(), temporary_path_, false);
    return;  // the destructor removes the temporary file
  }
  if (const int error = flush(); error != 0) {
    fail_to_write(given_path_, error);
  }
  if (::rename(temporary_path_.c_str(), final_path_.c_str()) != 0) {
    fail_to_write(given_path_, errno);
  }
  committed_ = true;
  forget_unfinished(temporary_path_);
  flush_name();
}

bool AtomicFile::commit_if_absent() {
  if (is_address(final_path_)) {
    return remote_files(final_path_).write(final_path_.string(), temporary_path_, true);
  }
  const int flush_error = flush();
  if (flush_error == 0 && ::link(temporary_path_.c_str(), final_path_.c_str()) == 0) {
    flush_name();
    return true;  // the destructor removes the temporary name
  }
  std::error_code ignored;
  if (fs::exists(final_path_, ignored)) {
    return false;
  }
  if (flush_error != 0) {
    fail_to_write(given_path_, flush_error);
  }
  commit();
  return true;
}

void fail_to_write(const fs::path& path, int error_number) {
  throw Error(fmt::format("cannot write {}: {}", path.string(),
                          std::generic_category().message(error_number)));
}

fs::path through_links(const fs::path& path) {
  if (is_address(path)) {
    return path;
  }
  constexpr int kMaxLinks = 40;  // the limit of Linux
  std::error_code error;
  fs::path place = path;
  for (int links = 0; fs::is_symlink(place, error); ++links) {
    const fs::path target = fs::read_symlink(place, error);
    if (error || links == kMaxLinks) {
      return path;
    }
    place = place.parent_path() / target;  // an absolute target is unchanged
  }
  return place;
}

void write_binary_file(const fs::path& path, std::span<const std::uint8_t> bytes) {
  AtomicFile target(path);
  fill(target.temporary_path(), bytes, path);
  target.commit();
}

void write_text_file(const fs::path& path, std::string_view text) {
  write_binary_file(path, bytes_of(text));
}

bool create_text_file(const fs::path& path, std::string_view text) {
  std::error_code ignored;
  if (fs::exists(path, ignored)) {  // of an address, commit_if_absent() tells
    return false;
  }
  AtomicFile target(path);
  fill(target.temporary_path(), bytes_of(text), path);
  return target.commit_if_absent();
}

}  // namespace vantage
