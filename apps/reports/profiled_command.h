#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "apps/commands/commands.h"
#include "apps/match/match_job.h"
#include "apps/process/scratch_folder.h"
#include "apps/run/run_settings.h"
#include "engine/options/settings.h"
#include "engine/profiling/profile_advice.h"

namespace vantage::apps {

/// A match or run command that is to be profiled: read and checked like the command itself, with
/// its results led to hidden folders beside the places that they are meant for.
class ProfiledCommand {
 public:
  /// `words`: "match" or "run" and its arguments. Null when --help, --help-all or --print-config
  /// has been answered on stdout. Throws UsageError for another command and for options that make
  /// no sense here, and what the command itself would throw before it begins to work.
  static std::unique_ptr<ProfiledCommand> read(const Arguments& words);

  [[nodiscard]] const std::string& name() const { return settings_.command(); }
  /// As it would be typed.
  [[nodiscard]] const std::string& text() const { return text_; }
  [[nodiscard]] const CommonOptions& common() const;
  /// What it was told, as far as other settings would take less time.
  [[nodiscard]] ProfiledChoices choices() const;
  /// Things about it that people should know.
  [[nodiscard]] const std::vector<std::string>& remarks() const { return remarks_; }
  /// The files that its settings name as inputs.
  [[nodiscard]] std::vector<std::string> inputs() const { return settings_.input_paths(); }
  /// Where its first result is meant to go.
  [[nodiscard]] const std::filesystem::path& place() const { return place_; }

  /// A settings file for it on `threads` threads that writes these files.
  [[nodiscard]] std::string job_file(int threads, const std::string& report,
                                     const std::string& trace);
  /// Removes the results of a run.
  void clear_results() const;

 private:
  ProfiledCommand(const Arguments& words, bool is_match);
  [[nodiscard]] CommonOptions& changeable_common();
  void check();
  void redirect();
  void redirect(std::string& path);

  std::variant<MatchJob, RunJob> job_;
  Settings settings_;  // bound to job_
  std::string text_;
  std::vector<std::string> remarks_;
  std::filesystem::path place_;
  std::map<std::filesystem::path, ScratchFolder> folders_;  // by the folder they stand for
};

}  // namespace vantage::apps
