// What a run, a scene and the tuner keep. Where a text has a checksum, it is made right.
#include "engine/io/files/checksum.h"
#include "engine/scene_graph/scene_json.h"
#include "engine/sequence/journal/journal_json.h"
#include "engine/sequence/shots/shots.h"
#include "engine/tuning/tuning_file.h"
#include "tests/fuzz/target.h"

namespace vantage::fuzz {
namespace {

/// Records that are read are written as they were.
void read_journal_line(Bytes bytes) {
  const std::string text = text_of(bytes);
  (void)record_of(text);
  if (const auto record = record_of(with_checksum(text))) {
    const std::string line = line_of(*record);
    const auto again = record_of(line);
    require(again && line_of(*again) == line, "the same record");
  }
}

void read_identity(Bytes bytes) {
  const RunIdentity identity = identity_of(with_checksum(text_of(bytes)), "input");
  const RunIdentity again = identity_of(text_of(identity), "input");
  require(difference(identity, again).empty(), "the same run");
}

void read_shots(Bytes bytes) {
  const std::string text = with_checksum(text_of(bytes));
  (void)read_shot_table(
      file_of(Bytes(reinterpret_cast<const std::uint8_t*>(text.data()), text.size())));
}

void read_scene_text(Bytes bytes) {
  const std::string text = scene_text(parse_scene(text_of(bytes), "input"));
  require(scene_text(parse_scene(text, "input again")) == text, "the same scene");
}

/// Damage is a warning, never an exception.
void read_tuning(Bytes bytes) {
  for (const std::string& warning : read_tuning_file(file_of(bytes)).warnings) {
    require(warning.find('\n') == std::string::npos, "a warning of one line");
  }
}

const Registration kJournal("journal", read_journal_line, false);
const Registration kRun("run_json", read_identity);
const Registration kShots("shots", read_shots);
const Registration kScene("scene_json", read_scene_text);
const Registration kTuning("tuning", read_tuning);

}  // namespace
}  // namespace vantage::fuzz
