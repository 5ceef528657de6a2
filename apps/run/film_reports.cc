#include "apps/run/film_reports.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <vector>

#include "apps/pages/comfort_page.h"
#include "apps/process/tell.h"
#include "engine/error.h"
#include "engine/io/files/atomic_file.h"
#include "engine/io/files/file_descriptor.h"
#include "engine/io/files/temporary_name.h"
#include "engine/sequence/journal/journal_content.h"
#include "engine/sequence/shots/depth_picture.h"
#include "engine/sequence/shots/shots.h"

namespace vantage::apps {
namespace {

std::string document_of(const SettingValue& value) {
  // File names need not be UTF-8, JSON must be.
  return value.dump(2, ' ', false, SettingValue::error_handler_t::replace) + "\n";
}

/// The part of the shots that lies in `frames`.
std::vector<Shot> shots_in(const ShotTable& table, FrameRange frames) {
  std::vector<Shot> shots;
  for (Shot shot : table.shots) {
    shot.first_frame = std::max(shot.first_frame, frames.first);
    shot.end_frame = std::min(shot.end_frame, frames.end);
    if (shot.first_frame < shot.end_frame) {
      shots.push_back(shot);
    }
  }
  return shots;
}

SettingValue depth_values(const SequenceOptions& options, const ShotTable& table,
                          FrameRange frames) {
  SettingValue shots = SettingValue::array();
  for (const Shot& shot : shots_in(table, frames)) {
    const PreviewRange range =
        depth_range_of(options.depth_scale, options.match.disparities, &table, shot.first_frame);
    shots.push_back({{"first_frame", shot.first_frame - frames.first},
                     {"end_frame", shot.end_frame - frames.first},
                     {"min_px", double{range.min_px}},
                     {"max_px", double{range.max_px}}});
  }
  const int bits = traits_of(options.depth_coding).bits;
  const int white = (1 << bits) - 1;
  return {
      {"bits", bits},
      {"frames_per_second", to_string(options.frame_rate)},
      {"unknown", 0},
      {"disparity_px", fmt::format("min_px + (level - 1) / {} * (max_px - min_px), level 1 to {}",
                                   white - 1, white)},
      {"shots", shots}};
}

/// Writes the reports of a run and records them. Unfinished ones of killed processes are removed
/// first.
class ReportFiles {
 public:
  explicit ReportFiles(const SequenceLayout& layout) : layout_(layout) {
    for (const std::string& name : layout.report_names()) {
      remove_temporary_files_of(layout.folder() / name);
    }
  }

  void write(const std::filesystem::path& path, const std::string& text) {
    write_text_file(path, text);
    written_.push_back(record_of_file(layout_.folder(), path.filename().string()));
  }

  /// Adds the written files to the journal, unless it has them with this content.
  void record(FrameRange frames, RunJournal& journal) const {
    const JournalContent known = read_journal(layout_);
    const bool is_known = std::ranges::all_of(written_, [&](const FileRecord& file) {
      const auto contents = known.contents.find(file.name);
      return contents != known.contents.end() &&
             std::ranges::find(contents->second, file.content) != contents->second.end();
    });
    if (!is_known) {
      const JournalRecord record = ReportRecord{frames, written_};
      journal.append({&record, 1});
    }
  }

 private:
  const SequenceLayout& layout_;
  std::vector<FileRecord> written_;
};

std::optional<ComfortReport> write_comfort(const SequenceOptions& options,
                                           const SequenceLayout& layout,
                                           const RunIdentity& identity, const ShotTable& table,
                                           FrameRange frames, ReportFiles& reports) {
  std::map<int, FrameComfort> measured;
  const DeliveredFrames delivered(layout);
  for (const auto& [frame, record] : delivered.records()) {
    if (record.comfort && frames.contains(frame)) {
      measured.emplace(frame, *record.comfort);
    }
  }
  if (measured.empty()) {
    return std::nullopt;
  }
  std::vector<ComfortSpan> spans;
  for (const Shot& shot : shots_in(table, frames)) {
    spans.push_back({shot.first_frame, shot.end_frame});
  }
  ComfortReport report = summarise_comfort(measured, spans);
  const std::string input = identity.inputs.empty() ? std::string() : identity.inputs.front();
  const ComfortPage page{report, measured, options.frame_rate,
                         identity.times_at(options.frame_rate), input.substr(0, input.rfind(": "))};
  reports.write(layout.comfort_report("json"), document_of(comfort_values(page)));
  reports.write(layout.comfort_report("html"), make_comfort_page(page));
  return report;
}

}  // namespace

std::optional<ComfortReport> write_film_reports(const SequenceOptions& options,
                                                const SequenceLayout& layout, FrameRange frames,
                                                RunJournal& journal) {
  const bool has_depth = options.saves(SequenceOutput::kDepthVideo);
  const bool has_comfort = options.saves(SequenceOutput::kComfort);
  if (frames.empty() || (!has_depth && !has_comfort)) {
    return std::nullopt;
  }
  // As the run was started: a resumed one may know its input by another path.
  const RunIdentity identity = RunJournal::read_identity(layout.journal_folder());
  const std::filesystem::path file = layout.journal_folder() / kShotsFile;
  std::optional<ShotTable> table = read_shot_table(file);
  if (!table && identity.is_stream()) {
    table = shots_at({}, frames, options);  // the run was killed before it knew the cuts
  }
  if (!table) {
    throw Error(
        fmt::format("{}: is missing, expected the shots of the run; --overwrite starts the "
                    "run again",
                    file.string()));
  }
  // Several processes may find at the same time that all frames exist.
  const FileLock lock(layout.journal_folder() / "run.json", FileLock::Wait::kYes);
  ReportFiles reports(layout);
  if (has_depth) {
    reports.write(layout.depth_description(), document_of(depth_values(options, *table, frames)));
  }
  std::optional<ComfortReport> comfort;
  if (has_comfort) {
    comfort = write_comfort(options, layout, identity, *table, frames, reports);
  }
  reports.record(frames, journal);
  return comfort;
}

void print_comfort(const std::string& command, const ComfortReport& report,
                   const SequenceLayout& layout) {
  int unsafe = 0;
  int borderline = 0;
  for (const ComfortSummary& shot : report.shots) {
    unsafe += shot.verdict == ComfortVerdict::kUnsafe ? 1 : 0;
    borderline += shot.verdict == ComfortVerdict::kBorderline ? 1 : 0;
  }
  tell(
      "{}: comfort: {}; {:.2f} % of the width in front of the screen, {:.2f} % behind it; of {} "
      "shot{} {} unsafe, {} borderline -> {}\n",
      command, name_of(report.film.verdict), report.film.crossed_percent,
      report.film.uncrossed_percent, report.shots.size(), report.shots.size() == 1 ? "" : "s",
      unsafe, borderline, layout.comfort_report("html").string());
}

}  // namespace vantage::apps
