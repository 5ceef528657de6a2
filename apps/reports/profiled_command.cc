#include "apps/reports/profiled_command.h"

#include <fmt/format.h>

#include <array>
#include <optional>
#include <utility>

#include "apps/process/child_process.h"
#include "apps/settings/command_line.h"
#include "engine/error.h"
#include "engine/quoted_text.h"

namespace vantage::apps {
namespace {

namespace fs = std::filesystem;

std::string as_typed(const Arguments& words) {
  std::string text = "vantage";
  for (const std::string& word : words) {
    text += " " + shell_word(word);
  }
  return text;
}

void refuse_if(bool given, const char* option, const char* instead) {
  if (given) {
    throw UsageError(fmt::format("--{} cannot be profiled: {}", option, instead));
  }
}

}  // namespace

std::unique_ptr<ProfiledCommand> ProfiledCommand::read(const Arguments& words) {
  const std::string& name = words.front();
  if (name != "match" && name != "run") {
    throw UsageError(fmt::format(
        "'{}' cannot be profiled, expected match or run with its arguments", quotable(name)));
  }
  std::unique_ptr<ProfiledCommand> command(new ProfiledCommand(words, name == "match"));
  if (!read_command_line(command->settings_, Arguments(words.begin() + 1, words.end()))) {
    return nullptr;
  }
  command->check();
  command->redirect();
  return command;
}

ProfiledCommand::ProfiledCommand(const Arguments& words, bool is_match)
    : job_(is_match ? std::variant<MatchJob, RunJob>(MatchJob()) : RunJob()),
      settings_(words.front(), "The command that is profiled."),
      text_(as_typed(words)) {
  if (is_match) {
    add_match_job_settings(settings_, std::get<MatchJob>(job_));
  } else {
    settings_.take_job_file();
    add_run_settings(settings_, std::get<RunJob>(job_));
  }
}

const CommonOptions& ProfiledCommand::common() const {
  return std::visit([](const auto& job) -> const CommonOptions& { return job.common; }, job_);
}

ProfiledChoices ProfiledCommand::choices() const {
  const auto* match_job = std::get_if<MatchJob>(&job_);
  const auto* run_job = std::get_if<RunJob>(&job_);
  const MatchOptions& match = match_job != nullptr ? match_job->match : run_job->sequence.match;
  bool needs_both = false;  // maps, for themselves
  bool has_several = false;
  if (match_job != nullptr) {
    has_several = match_job->has_several();
    needs_both = match_job->wants_right() && match_job->is_left();
  } else {
    has_several = !run_job->sequence.baselines.empty();
    needs_both = !run_job->sequence.views.empty();
    for (const SequenceOutput output : {SequenceOutput::kRightDisparity,
                                        SequenceOutput::kRightUnmatched, SequenceOutput::kStereo}) {
      needs_both = needs_both || run_job->sequence.saves(output);
    }
  }
  const RefinementOptions refinement = match.resolved_refinement();
  ProfiledChoices choices;
  choices.preset = has_several ? std::nullopt : match.preset_in_force();
  choices.estimates_range = match.disparities_auto;
  choices.candidates = match.disparities_auto ? 0 : match.disparities.count();
  choices.checks_rows = match_job != nullptr ? match_job->rows.check : run_job->check_rectification;
  choices.has_map_for_check_only =
      !match.raw && refinement.cross_check && !needs_both && !has_several;
  return choices;
}

CommonOptions& ProfiledCommand::changeable_common() {
  return std::visit([](auto& job) -> CommonOptions& { return job.common; }, job_);
}

void ProfiledCommand::check() {
  refuse_if(!common().report.empty(), "report",
            "each run writes its own, --json keeps the profile");
  refuse_if(!common().trace.empty(), "trace", "each run writes its own, --html shows one of them");
  if (auto* match = std::get_if<MatchJob>(&job_)) {
    apps::check(*match, settings_);
    return;
  }
  auto& run = std::get<RunJob>(job_);
  refuse_if(run.dry_run, "dry-run", "it does no work");
  refuse_if(run.show, "show", "it takes time");
  complete(run, settings_);
  const std::array<std::pair<bool*, const char*>, 3> openings = {
      {{&run.resume, "resume"}, {&run.overwrite, "overwrite"}, {&run.force, "force"}}};
  for (const auto& [given, option] : openings) {
    if (std::exchange(*given, false)) {
      remarks_.push_back(fmt::format("--{} is left out: each run starts again", option));
    }
  }
}

void ProfiledCommand::redirect() {
  if (auto* run = std::get_if<RunJob>(&job_)) {
    redirect(run->output);
    return;
  }
  auto& match = std::get<MatchJob>(job_);
  for (std::string* path : {&match.output, &match.output_right, &match.confidence,
                            &match.volume.file, &match.posterior_mean, &match.posterior_variance,
                            &match.unmatched, &match.unmatched_right, &match.preview}) {
    if (!path->empty()) {
      redirect(*path);
    }
  }
}

void ProfiledCommand::redirect(std::string& path) {
  const fs::path wanted = fs::absolute(path).lexically_normal();
  const fs::path place = wanted.has_filename() ? wanted : wanted.parent_path();
  if (place_.empty()) {
    place_ = place;
  }
  const auto& [folder, scratch] = *folders_.try_emplace(place.parent_path(), place).first;
  path = (scratch.path() / place.filename()).string();
}

std::string ProfiledCommand::job_file(int threads, const std::string& report,
                                      const std::string& trace) {
  CommonOptions& options = changeable_common();
  options.execution.threads = threads;
  options.report = report;
  options.trace = trace;
  return to_toml(settings_);
}

void ProfiledCommand::clear_results() const {
  for (const auto& [folder, scratch] : folders_) {
    scratch.clear();
  }
}

}  // namespace vantage::apps
