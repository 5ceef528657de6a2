// Options: of the command line, of a TOML file, and as keywords of Python.
#include "apps/settings/command_line.h"
#include "apps/settings/toml_file.h"
#include "engine/io/files/json_text.h"
#include "engine/jobs/sequence_job.h"
#include "engine/options/execution_settings.h"
#include "engine/options/match_settings.h"
#include "engine/options/metric_settings.h"
#include "engine/options/synthesis_settings.h"
#include "tests/fuzz/target.h"

namespace vantage::fuzz {
namespace {

/// What a run reads from its user, in the program and in Python.
struct Job : SequenceJob {
  Settings settings{"run", "Of a sequence"};
  ExecutionOptions execution;

  Job() {
    add_input_settings(settings, *this);
    add_save_setting(settings, *this);
    add_picture_settings(settings, *this);
    add_rig_scale_settings(settings, rig);
    add_disparity_resolution_setting(settings, sequence.disparity_step_px);
    add_cloud_settings(settings, sequence.cloud);
    add_poses_setting(settings, *this);
    add_match_settings(settings, sequence.match);
    add_synthesis_settings(settings, sequence.synthesis);
    add_steadiness_settings(settings, *this);
    add_chunk_frames_setting(settings, *this);
    add_in_flight_setting(settings, *this);
    add_execution_settings(settings, execution);
  }

  /// What follows reading. Settings that are kept in a journal give the same settings again.
  void use() {
    const SettingValue values = settings.result_values();
    Job again;
    again.settings.set_values(values);
    require(again.settings.result_values() == values, "the same settings");
    execution.validate();
    complete_sequence(*this, false);
    check_sequence(*this, settings);
  }
};

/// A line is an argument.
void read_arguments(Bytes bytes) {
  Job job;
  if (apps::read_command_line(job.settings, split(text_of(bytes), '\n'))) {
    (void)apps::to_toml(job.settings);
    job.use();
  }
}

void read_settings_toml(Bytes bytes) {
  Job job;
  if (apps::read_command_line(job.settings, {"--config", file_of(bytes, "input.toml").string()})) {
    job.use();
  }
}

void read_any_toml(Bytes bytes) {
  (void)apps::read_toml_document(file_of(bytes, "input.toml").string());
}

/// Python's keywords arrive as JSON's values.
void read_keywords(Bytes bytes) {
  Job job;
  job.settings.take_values(parse_json(text_of(bytes), "input"));
  job.use();
}

const Registration kArguments("arguments", read_arguments, false);
const Registration kSettingsToml("settings_toml", read_settings_toml, false);
const Registration kToml("toml", read_any_toml);
const Registration kKeywords("keywords", read_keywords, false);

}  // namespace
}  // namespace vantage::fuzz
