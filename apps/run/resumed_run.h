#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "apps/commands/commands.h"
#include "apps/run/run_settings.h"
#include "engine/image/disparity_range.h"
#include "engine/options/settings.h"

namespace vantage::apps {

/// What run.json keeps beside the settings that results depend on, so that the run can be gone on
/// with by its folder alone: a JSON object of where the input is, and --keep-going.
std::string sources_of(const RunJob& job, const Settings& settings);

/// The part of a run that --resume continues; without fields: all of it.
struct RunPart {
  std::optional<FrameRange> frames;
  std::optional<Shard> shard;

  [[nodiscard]] bool is_all() const { return !frames && !shard; }
};

/// The frames that all started parts have in common (--frames), and the shard if there is only one.
/// Throws Error when the folder cannot be read.
RunPart resumed_part(const std::filesystem::path& journal_folder);

/// Where --resume comes without an input, fills in `job`, to which `settings` are bound, from the
/// run in its folder; what `arguments` say goes before that. Without --frames and --shard, its part
/// is resumed_part(). Throws Error when there is no run.
void take_up_run(const Arguments& arguments, Settings& settings, RunJob& job);

/// The search range of the run that `job` resumes, as estimated at its start from the same input.
/// Empty if `job` does not resume a run.
std::optional<DisparityRange> range_of_run_to_resume(const RunJob& job);

/// Gives `job` the rows that were found when the run that it resumes began, if it resumes one.
void take_up_rows(RunJob& job);

}  // namespace vantage::apps
