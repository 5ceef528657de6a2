#include "engine/sequence/journal/leftovers.h"

#include <fmt/format.h>

#include <charconv>
#include <filesystem>
#include <string>
#include <system_error>

#include "engine/error.h"
#include "engine/io/files/temporary_name.h"
#include "engine/sequence/journal/run_journal.h"

namespace vantage {
namespace {

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
  for (const OutputStream& stream : layout.streams()) {
    const std::filesystem::path place =
        stream.as_video ? layout.video(stream) : layout.folder() / stream.name;
    std::error_code ignored;
    // In this order: another part of the same run may have begun.
    if (std::filesystem::exists(place, ignored) && !std::filesystem::is_empty(place, ignored) &&
        RunJournal::parts(layout.journal_folder()).empty()) {
      throw Error(fmt::format(
          "{} holds files that no run made, expected a folder without them; `overwrite` replaces "
          "those of the same names",
          place.string()));
    }
  }
}

}  // namespace vantage
