#include "engine/io/store/folder_store.h"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <set>
#include <system_error>
#include <vector>

#include "engine/error.h"
#include "engine/io/files/atomic_file.h"
#include "engine/io/files/file_descriptor.h"
#include "engine/io/files/random_access_file.h"
#include "engine/io/files/temporary_name.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;

std::optional<ObjectInfo> info_of_file(const fs::path& file) {
  struct stat status {};
  if (::stat(file.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) {
    return std::nullopt;
  }
  const auto bytes = static_cast<std::uint64_t>(status.st_size);
  return ObjectInfo{.bytes = bytes,
                    .etag = fmt::format("{:x}-{:x}.{:x}-{:x}", bytes, status.st_mtim.tv_sec,
                                        status.st_mtim.tv_nsec, status.st_ino)};
}

}  // namespace

std::optional<ObjectInfo> FolderStore::info(const std::string& key) {
  return info_of_file(folder_ / key);
}

ObjectPart FolderStore::read(const std::string& key, std::optional<ByteRange> range,
                             const std::string& etag, std::uint64_t max_bytes) {
  const fs::path file = folder_ / key;
  const std::unique_ptr<RandomAccessFile> opened = open_random_access(file);
  ObjectPart part{.info = info_of_file(file).value_or(ObjectInfo())};
  if (!etag.empty() && part.info.etag != etag) {
    throw Error(fmt::format("{}: has changed since it was begun", file.string()));
  }
  part.begin = range ? std::min(range->begin, opened->size()) : 0;
  const std::uint64_t rest = opened->size() - part.begin;
  const std::uint64_t count = range ? std::min(range->count, rest) : rest;
  if (count > max_bytes) {
    throw Error(fmt::format("{}: has more than {} bytes", file.string(), max_bytes));
  }
  part.bytes.resize(static_cast<std::size_t>(count));
  part.bytes.resize(opened->read(part.begin, part.bytes));
  return part;
}

std::optional<std::string> FolderStore::put(const std::string& key,
                                            std::span<const std::uint8_t> bytes,
                                            const PutCondition& condition) {
  const fs::path file = folder_ / key;
  std::error_code ignored;  // AtomicFile names a folder that is missing
  fs::create_directories(file.parent_path(), ignored);
  std::optional<FileLock> lock;
  if (condition.if_absent) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (!create_text_file(file, text)) {
      return std::nullopt;
    }
  } else {
    if (!condition.if_etag.empty()) {
      // Who has waited for a file that was replaced meanwhile finds another ETag.
      lock.emplace(file, FileLock::Wait::kYes);
      if (info(key).value_or(ObjectInfo()).etag != condition.if_etag) {
        return std::nullopt;
      }
    }
    write_binary_file(file, bytes);
  }
  return info(key).value_or(ObjectInfo()).etag;
}

void FolderStore::list(const std::string& prefix, bool one_level,
                       const std::function<bool(const ListedObject&)>& visit) {
  const fs::path begin = folder_ / prefix.substr(0, prefix.rfind('/') + 1);
  std::vector<ListedObject> found;
  std::error_code error;
  for (fs::recursive_directory_iterator entry(begin, error), end; !error && entry != end;
       entry.increment(error)) {
    std::string key = entry->path().lexically_relative(folder_).generic_string();
    std::error_code gone;  // other processes rename and remove files meanwhile
    const bool is_folder = entry->is_directory(gone);
    key += is_folder ? "/" : "";
    if (one_level && is_folder) {
      entry.disable_recursion_pending();
    }
    const std::optional<ObjectInfo> info = is_folder ? ObjectInfo() : info_of_file(entry->path());
    if (key.starts_with(prefix) && info && (one_level || !is_folder) &&
        !final_name_of(entry->path().filename().string())) {
      found.push_back({key, *info, is_folder});
    }
  }
  if (error && error != std::errc::no_such_file_or_directory) {
    throw Error(fmt::format("cannot read the folder {}: {}", begin.string(), error.message()));
  }
  std::ranges::sort(found, {}, &ListedObject::key);
  (void)std::ranges::all_of(found, visit);
}

void FolderStore::remove(const std::string& key) {
  std::error_code error;
  fs::remove(folder_ / key, error);
  if (error) {
    throw Error(fmt::format("cannot remove {}: {}", (folder_ / key).string(), error.message()));
  }
}

void FolderStore::check_writable(const std::string&) {
  if (::access(folder_.c_str(), W_OK | X_OK) != 0) {
    throw Error(fmt::format("{}: cannot be written, expected a folder with the permission to write",
                            folder_.string()));
  }
}

}  // namespace vantage
