#include "engine/sequence/leftovers.h"

#include <charconv>
#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

namespace vantage {
namespace {

namespace fs = std::filesystem;

/// Hidden files are named after the file to be: ".000012.pfm.<process>.pending" (PendingFiles),
/// ".000000-000049.tmp-<process>-0.mp4" (AtomicFile).
bool is_of_frames(const std::string& name, FrameRange frames) {
  if (!name.starts_with('.') ||
      (!name.ends_with(".pending") && name.find(".tmp-") == std::string::npos)) {
    return false;
  }
  int frame = -1;
  const auto [end, error] = std::from_chars(name.data() + 1, name.data() + name.size(), frame);
  return error == std::errc{} && frames.contains(frame);
}

template <typename IsLeftover>
void remove_files(const fs::path& folder, const IsLeftover& is_leftover) {
  std::vector<fs::path> found;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    if (is_leftover(entry->path().filename().string())) {
      found.push_back(entry->path());
    }
  }
  for (const fs::path& path : found) {
    fs::remove(path, error);
  }
}

}  // namespace

void remove_leftovers(const SequenceLayout& layout, FrameRange frames) {
  for (const OutputStream& stream : layout.streams()) {
    const fs::path folder = stream.as_video ? layout.segment(stream, frames).parent_path()
                                            : layout.folder() / stream.name;
    remove_files(folder, [&](const std::string& name) { return is_of_frames(name, frames); });
  }
  for (const char* name : {"run.json", kShotsFile}) {
    remove_leftovers_of(layout.journal_folder() / name);
  }
}

void remove_leftovers_of(const fs::path& file) {
  const std::string begin = "." + file.stem().string() + ".tmp-";
  remove_files(file.parent_path(), [&](const std::string& name) {
    return name.starts_with(begin) && fs::path(name).extension() == file.extension();
  });
}

}  // namespace vantage
