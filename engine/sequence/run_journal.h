#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "engine/io/checksum.h"
#include "engine/io/frame_rate.h"
#include "engine/sequence/flicker.h"
#include "engine/sequence/frame_range.h"

namespace vantage {

/// What the files of a run depend on. Two processes that work in one folder must agree on it.
struct RunIdentity {
  std::string settings = "{}";  ///< a JSON object: the settings that results depend on
  /// Another one: where the input was when the run began, for going on without being told. Two
  /// processes need not agree on it.
  std::string sources = "{}";
  /// A line per source, see FrameSource::identity(). What follows the last ": " must be the same.
  std::vector<std::string> inputs;
  int frame_count = 0;               ///< of the whole input
  std::filesystem::path sound_file;  ///< video that sound is taken from; empty: none
  int sound_first_frame = 0;         ///< the frame of it that frame 0 of the run is
  FrameRate sound_rate;              ///< of the frames of that video
};

/// A result.
struct FileRecord {
  std::string name;  ///< relative to the run's folder
  FileContent content = {};
  friend bool operator==(const FileRecord&, const FileRecord&) = default;
};

/// How one frame ended.
struct FrameRecord {
  int frame = 0;
  bool skipped = false;
  bool absent = false;       ///< the input ends before it: there is nothing to be made of it
  std::string problem = {};  ///< why it was skipped
  std::vector<std::string> remarks = {};  ///< what was odd about a frame that is done
  std::vector<FileRecord> files = {};
  FlickerSums flicker = {};  ///< all 0 where it was not measured
};

/// All videos have a segment of these frames.
struct SegmentRecord {
  FrameRange frames;
  std::vector<FileRecord> files = {};
};

/// The videos of these frames have been joined and their segments removed.
struct JoinRecord {
  FrameRange frames;
  std::vector<int> skipped = {};  ///< of `frames`, those of which the videos show a neighbour
  std::vector<FileRecord> files = {};
};

using JournalRecord = std::variant<FrameRecord, SegmentRecord, JoinRecord>;

/// What is recorded of `name`, which has just been written below `folder`. Throws Error when it
/// cannot be read.
FileRecord record_of_file(const std::filesystem::path& folder, const std::string& name);

struct JournalRecords {
  std::vector<JournalRecord> records;
  int damaged_lines = 0;  ///< that cannot be believed
};

/// What a process may find in the folder it is to work in.
enum class JournalOpening {
  kNew,       ///< no run; or, for a part of a run, the same run without this part
  kResume,    ///< nothing, or the same run
  kForce,     ///< nothing, or any run: what it holds counts as done
  kOverwrite  ///< anything: an old journal is removed
};

/// The journal in DIR/.vantage: run.json says what the run is, frames-PART.jsonl what has been
/// finished, a line each, written after the files it tells of are safe. Every process appends to a
/// file of its own, which it locks; all read all. run.json and each line hold a checksum of
/// themselves.
///
/// Thread rule: one thread at a time.
class RunJournal {
 public:
  /// `part` names this process's share of the run ("all", "2-of-7"). Throws Error when the folder
  /// holds something else than `opening` allows, naming what differs, when another process works on
  /// the same part, or when nothing can be written.
  RunJournal(const std::filesystem::path& journal_folder, const RunIdentity& identity,
             JournalOpening opening, const std::string& part);
  ~RunJournal();
  RunJournal(RunJournal&&) noexcept;
  RunJournal& operator=(RunJournal&&) = delete;

  /// Appends and flushes. Throws Error; records are then not to be counted on.
  void append(std::span<const JournalRecord> records);

  /// Whether the folder holds a run.
  static bool is_present(const std::filesystem::path& journal_folder);
  /// The parts that have been begun, as the constructor names them, in order.
  static std::vector<std::string> parts(const std::filesystem::path& journal_folder);
  /// Throws Error when there is none, or it is damaged or of another version.
  static RunIdentity read_identity(const std::filesystem::path& journal_folder);
  /// The records of all parts, each part's in order. Lines that were cut off by a crash are no
  /// lines. Throws Error when a file cannot be read.
  static JournalRecords read_records(const std::filesystem::path& journal_folder);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace vantage
