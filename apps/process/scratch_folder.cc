#include "apps/process/scratch_folder.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string>
#include <system_error>

#include "engine/error.h"

namespace vantage::apps {
namespace {

namespace fs = std::filesystem;

/// The nearest existing folder above `path`, which need not exist.
fs::path nearest_folder_above(const fs::path& path) {
  std::error_code ignored;
  fs::path folder = fs::absolute(path).lexically_normal().parent_path();
  while (!fs::is_directory(folder, ignored) && folder.has_relative_path()) {
    folder = folder.parent_path();
  }
  return folder;
}

}  // namespace

ScratchFolder::ScratchFolder(const fs::path& path) {
  const fs::path folder = nearest_folder_above(path);
  std::string name = (folder / ".vantage-profile-XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr) {
    throw Error(fmt::format("{}: no temporary folder can be made in it: {}", folder.string(),
                            std::strerror(errno)));
  }
  path_ = name;
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

void ScratchFolder::clear() const {
  std::error_code ignored;
  for (const fs::directory_entry& entry : fs::directory_iterator(path_, ignored)) {
    fs::remove_all(entry.path(), ignored);
  }
}

}  // namespace vantage::apps
