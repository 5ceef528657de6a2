#include "engine/io/files/existing_files.h"

#include <fmt/format.h>

#include <system_error>

#include "engine/error.h"

namespace vantage {

namespace fs = std::filesystem;

fs::path existing_file(const fs::path& folder,
                       const std::function<bool(const std::string& name)>& is_made) {
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    if (entry.is_regular_file(ignored) && is_made(entry.path().filename().string())) {
      return entry.path();
    }
  }
  return {};
}

void refuse_to_replace(const fs::path& file) {
  throw Error(
      fmt::format("{} is there, expected a folder without such files; `overwrite` replaces them",
                  file.string()));
}

void require_no_existing_file(const fs::path& folder,
                              const std::function<bool(const std::string& name)>& is_made) {
  if (const fs::path file = existing_file(folder, is_made); !file.empty()) {
    refuse_to_replace(file);
  }
}

}  // namespace vantage
