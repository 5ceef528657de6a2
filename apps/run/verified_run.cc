#include "apps/run/verified_run.h"

#include <fmt/format.h>

#include "apps/process/interrupt.h"
#include "engine/error.h"
#include "engine/io/files/checksum.h"

namespace vantage::apps {

RunVerification verify_with_progress(const SequenceLayout& layout, const std::string& command,
                                     ProgressStyle style) {
  Progress progress(command, "files", style);
  return verify_run(
      layout, [&](int done, int total) { progress.update(done, total, 0); }, &interrupt_flag());
}

bool require_unchanged_frames(const SequenceLayout& layout, const DeliveredFrames& delivered,
                              FrameRange frames, const std::string& command, ProgressStyle style) {
  Progress progress(command, "frames", style);
  int done = 0;
  for (const auto& [frame, record] : delivered.records()) {
    if (interrupt_flag()) {
      return false;
    }
    if (!frames.contains(frame)) {
      continue;
    }
    for (const FileRecord& file : record.files) {
      if (file_content(layout.folder() / file.name) != file.content) {
        const std::string folder = layout.folder().string();
        throw Error(fmt::format(
            "{}: {} is not as it was written; 'vantage verify {} --remove' and 'vantage run -o {} "
            "--resume' write it again",
            folder, file.name, folder, folder));
      }
    }
    progress.update(++done, frames.count(), 0);
  }
  return true;
}

SettingValue to_value(const RunVerification& verification) {
  SettingValue damaged = SettingValue::array();
  for (const DamagedFile& file : verification.damaged) {
    damaged.push_back({{"file", file.name}, {"problem", file.problem}});
  }
  return {{"files", verification.files},
          {"bytes", verification.bytes},
          {"damaged", damaged},
          {"damaged_journal_lines", verification.damaged_lines}};
}

std::string describe_damage(const RunVerification& verification, const std::string& folder) {
  std::string text;
  const auto add = [&](const std::string& part) { text += (text.empty() ? "" : ", ") + part; };
  if (const std::size_t count = verification.damaged.size(); count > 0) {
    const DamagedFile& first = verification.damaged.front();
    add(fmt::format("{} {}{}", first.name, first.problem,
                    count > 1 ? fmt::format(" (and {} more files)", count - 1) : std::string()));
  }
  if (const int lines = verification.damaged_lines; lines > 0) {
    add(fmt::format("{} line{} of the journal {} damaged", lines, lines == 1 ? "" : "s",
                    lines == 1 ? "is" : "are"));
  }
  return fmt::format("{}: {}; expected all as it was written", folder, text);
}

}  // namespace vantage::apps
