#include "engine/sequence/journal/leftovers.h"

#include <fmt/format.h>

#include <charconv>
#include <filesystem>
#include <limits>
#include <string>
#include <system_error>

#include "engine/error.h"
#include "engine/io/files/temporary_name.h"
#include "engine/sequence/journal/run_journal.h"

namespace vantage {
namespace {

constexpr FrameRange kAll{0, std::numeric_limits<int>::max()};

/// Files of frames are named "000012.pfm", segments "000000-000049.mp4".
bool is_of_frames(const std::string& name, FrameRange frames) {
  int frame = -1;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), frame);
  return error == std::errc{} && frames.contains(frame);
}

}  // namespace

void remove_leftovers(const SequenceLayout& layout, FrameRange frames) {
  for (const OutputStream& stream : layout.streams()) {
    const std::filesystem::path folder = stream.as_video
                                             ? layout.segment(stream, frames).parent_path()
                                             : layout.folder() / stream.name;
    remove_temporary_files(folder,
                           [&](const std::string& name) { return is_of_frames(name, frames); });
  }
  for (const char* name : {"run.json", kShotsFile}) {
    remove_temporary_files_of(layout.journal_folder() / name);
  }
}

void require_no_foreign_files(const SequenceLayout& layout) {
  std::error_code ignored;
  for (const OutputStream& stream : layout.streams()) {
    std::filesystem::path found;
    if (stream.as_video && std::filesystem::exists(layout.video(stream), ignored)) {
      found = layout.video(stream);
    } else if (!stream.as_video) {
      for (const auto& entry :
           std::filesystem::directory_iterator(layout.folder() / stream.name, ignored)) {
        if (entry.is_regular_file(ignored) &&
            is_of_frames(entry.path().filename().string(), kAll)) {
          found = entry.path();
          break;
        }
      }
    }
    // In this order: another part of the same run may have begun.
    if (!found.empty() && RunJournal::parts(layout.journal_folder()).empty()) {
      throw Error(fmt::format(
          "{} is there, and no run made it; expected a folder without such files, `overwrite` "
          "replaces them",
          found.string()));
    }
  }
}

}  // namespace vantage
