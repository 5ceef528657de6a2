#include "engine/sequence/pending_files.h"

#include <fmt/format.h>

#include <string>
#include <system_error>

#include "engine/error.h"

namespace vantage {

void PendingFiles::add(const std::filesystem::path& path,
                       const std::function<void(const std::filesystem::path&)>& write) {
  const std::filesystem::path hidden =
      path.parent_path() /
      fmt::format(".{}.pending{}", path.stem().string(), path.extension().string());
  files_.push_back({hidden, path});
  try {
    write(hidden);
  } catch (const Error& error) {
    // Users know the file by its final name.
    std::string message = error.what();
    if (const std::size_t at = message.find(hidden.string()); at != std::string::npos) {
      message.replace(at, hidden.string().size(), path.string());
    }
    throw Error(message);
  }
}

void PendingFiles::commit() {
  for (const File& file : files_) {
    std::error_code error;
    std::filesystem::rename(file.hidden, file.path, error);
    if (error) {
      throw Error(fmt::format("cannot write {}: {}", file.path.string(), error.message()));
    }
  }
  files_.clear();
}

void PendingFiles::discard() noexcept {
  for (const File& file : files_) {
    std::error_code ignored;
    std::filesystem::remove(file.hidden, ignored);
  }
  files_.clear();
}

}  // namespace vantage
