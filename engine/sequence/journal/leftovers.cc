#include "engine/sequence/journal/leftovers.h"

#include <charconv>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "engine/io/files/existing_files.h"
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
  std::vector<std::filesystem::path> found;
  const auto look_for = [&](const std::filesystem::path& file) {
    found.push_back(existing_file(
        file.parent_path(), [&](const std::string& name) { return name == file.filename(); }));
  };
  for (const OutputStream& stream : layout.streams()) {
    if (stream.as_video) {
      look_for(layout.video(stream));
    } else {
      found.push_back(existing_file(layout.folder() / stream.name, [](const std::string& name) {
        return is_of_frames(name, kAll);
      }));
    }
  }
  for (const std::string& name : layout.report_names()) {
    look_for(layout.folder() / name);
  }
  for (const std::filesystem::path& file : found) {
    // In this order: another part of the same run may have begun.
    if (!file.empty() && !RunJournal::is_present(layout.journal_folder())) {
      refuse_to_replace(file);
    }
  }
}

}  // namespace vantage
