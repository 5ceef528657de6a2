#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "engine/comfort/frame_comfort.h"
#include "engine/io/files/checksum.h"
#include "engine/io/video/frame_rate.h"
#include "engine/io/video/frame_source.h"
#include "engine/sequence/pairs/frame_range.h"
#include "engine/view_geometry/depth_resolution.h"

namespace vantage {

/// Inputs and settings that the files of a run depend on. Processes that share a folder must agree
/// on them.
struct RunIdentity {
  std::string settings = "{}";  ///< a JSON object: the settings that affect results
  /// Another JSON object: the input as given when the run started, for resuming without options.
  /// Processes need not agree on it.
  std::string sources = "{}";
  /// One line per source, see FrameSource::identity(). The text after the last ": " must be the
  /// same.
  std::vector<std::string> inputs;
  int frame_count = 0;               ///< of the whole input; kUnknownFrames: a stream
  std::filesystem::path sound_file;  ///< video that the sound is taken from; empty: none
  double sound_first_frame = 0;      ///< its frame that is frame 0 of the run
  FrameRate sound_rate;              ///< of the frames of that video
  /// Times of all frames of the run; videos of its rate have them. Empty: a constant rate.
  std::optional<FrameTimes> frame_times;
  /// Records in the folder are of another run; replacing it was interrupted. Not part of what
  /// processes must agree on.
  bool replaces_records = false;

  /// Times of the frames in videos of this rate; null: the rate is constant.
  [[nodiscard]] const FrameTimes* times_at(FrameRate rate) const {
    return frame_times && frame_times->rate == rate ? &*frame_times : nullptr;
  }
  /// Whether the input was a stream, which cannot be read again.
  [[nodiscard]] bool is_stream() const { return frame_count == kUnknownFrames; }
};

/// A result file.
struct FileRecord {
  std::string name;  ///< relative to the run's folder
  FileContent content = {};
  friend bool operator==(const FileRecord&, const FileRecord&) = default;
};

/// Outcome of one frame.
struct FrameRecord {
  int frame = 0;
  std::string name = {};  ///< of its files, instead of its number: PairDetails::name
  bool skipped = false;
  bool absent = false;                    ///< the input ends before it: no results
  std::string problem = {};               ///< why it was skipped
  std::vector<std::string> remarks = {};  ///< about a frame that is done
  std::vector<FileRecord> files = {};
  std::optional<FrameComfort> comfort = {};
  /// Empty unless depth resolutions are written, and where no disparity is known.
  std::optional<DisparitiesAndScale> disparities = {};
};

/// All videos have a segment of these frames.
struct SegmentRecord {
  FrameRange frames;
  std::vector<FileRecord> files = {};
};

/// The videos of these frames were joined and their segments removed.
struct JoinRecord {
  FrameRange frames;
  std::vector<int> skipped = {};  ///< of `frames`: the videos show a neighbour instead
  std::vector<FileRecord> files = {};
};

/// Reports on these frames were written: comfort.json, comfort.html, depth-video.json.
struct ReportRecord {
  FrameRange frames;
  std::vector<FileRecord> files = {};
};

using JournalRecord = std::variant<FrameRecord, SegmentRecord, JoinRecord, ReportRecord>;

/// The record of `name`, which was just written below `folder`. Throws Error when it cannot be
/// read.
FileRecord record_of_file(const std::filesystem::path& folder, const std::string& name);

struct JournalRecords {
  std::vector<JournalRecord> records;
  int damaged_lines = 0;  ///< with a wrong checksum
};

/// Accepted previous content of the folder.
enum class JournalOpening {
  kNew,       ///< no run; or, for a part of a run, the same run without this part
  kResume,    ///< no run, or the same run
  kForce,     ///< no run, or any run, whose results count as done
  kOverwrite  ///< anything: an old journal is removed; cut off, the old run or this one is there
};

/// The journal in DIR/.vantage: run.json describes the run, frames-PART.jsonl lists finished
/// frames, one per line, written when their files are safe. Every process appends to its own file,
/// which it locks; all processes read all files. run.json and each line contain their checksum.
///
/// Thread rule: one thread at a time.
class RunJournal {
 public:
  /// `part` names this process's share of the run ("all", "2-of-7"). Throws Error when the folder
  /// holds something else than `opening` allows, naming the difference, when another process works
  /// on the same part, or when nothing can be written.
  RunJournal(const std::filesystem::path& journal_folder, const RunIdentity& identity,
             JournalOpening opening, const std::string& part);
  ~RunJournal();
  RunJournal(RunJournal&&) noexcept;
  RunJournal& operator=(RunJournal&&) = delete;

  /// Appends and flushes. Throws Error; the records may then be lost.
  void append(std::span<const JournalRecord> records);

  /// Whether the folder holds a run.
  static bool is_present(const std::filesystem::path& journal_folder);
  /// The started parts, as named in the constructor, in order.
  static std::vector<std::string> parts(const std::filesystem::path& journal_folder);
  /// Throws Error when there is none, or it is damaged or of another version.
  static RunIdentity read_identity(const std::filesystem::path& journal_folder);
  /// The records of all parts, each part's in order. Lines truncated by a crash are ignored. Throws
  /// Error when a file cannot be read.
  static JournalRecords read_records(const std::filesystem::path& journal_folder);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace vantage
