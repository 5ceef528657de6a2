#include "engine/io/files/remote_files.h"

#include <fmt/format.h>

#include <string_view>
#include <system_error>
#include <utility>

#include "engine/error.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;

std::unique_ptr<RemoteFiles>& installed_files() {
  static std::unique_ptr<RemoteFiles> files;
  return files;
}

}  // namespace

bool is_address(const fs::path& path) {
  const std::string_view text = path.native();
  return text.starts_with("s3://") || text.starts_with("https://") || text.starts_with("http://");
}

void install_remote_files(std::unique_ptr<RemoteFiles> files) {
  installed_files() = std::move(files);
}

RemoteFiles& remote_files(const fs::path& address) {
  if (installed_files() == nullptr) {
    throw Error(
        fmt::format("{}: addresses are not opened here, expected a local file", address.string()));
  }
  return *installed_files();
}

void forget_remote_files() {
  if (installed_files() != nullptr) {
    installed_files()->forget();
  }
}

bool is_there(const fs::path& path) {
  std::error_code ignored;
  return is_address(path) ? remote_files(path).status(path.string()).has_value()
                          : fs::exists(path, ignored);
}

bool is_file(const fs::path& path) {
  std::error_code ignored;
  if (!is_address(path)) {
    return fs::is_regular_file(path, ignored);
  }
  const std::optional<FileStatus> status = remote_files(path).status(path.string());
  return status && !status->is_folder;
}

bool is_folder(const fs::path& path) {
  std::error_code ignored;
  if (!is_address(path)) {
    return fs::is_directory(path, ignored);
  }
  const std::optional<FileStatus> status = remote_files(path).status(path.string());
  return status && status->is_folder;
}

void read_ahead(const fs::path& path) {
  if (is_address(path)) {
    remote_files(path).read_ahead(path.string());
  }
}

std::uint64_t bytes_of_file(const fs::path& path) {
  if (is_address(path)) {
    return remote_files(path).status(path.string()).value_or(FileStatus()).bytes;
  }
  std::error_code error;
  const std::uintmax_t bytes = fs::file_size(path, error);
  return error ? 0 : bytes;
}

fs::path joined_path(const fs::path& folder, const fs::path& name) {
  return is_address(name) ? name : folder / name;
}

fs::path absolute_path(const fs::path& path) {
  return is_address(path) ? path : fs::absolute(path);
}

void require_local_folder(const fs::path& folder) {
  if (is_address(folder)) {
    throw UsageError(fmt::format("{}: expected a local folder for results", folder.string()));
  }
}

}  // namespace vantage
