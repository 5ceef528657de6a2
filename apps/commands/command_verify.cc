#include <fmt/format.h>

#include <filesystem>
#include <string>
#include <system_error>

#include "apps/commands/commands.h"
#include "apps/process/outputs.h"
#include "apps/process/tell.h"
#include "apps/reports/run_report.h"
#include "apps/run/run_session.h"
#include "apps/run/run_settings.h"
#include "apps/run/verified_run.h"
#include "apps/settings/command_line.h"
#include "engine/error.h"
#include "engine/sequence/journal/delivered_frames.h"

namespace vantage::apps {
namespace {

struct VerifyJob {
  std::string folder;
  bool remove = false;
  std::string report;
  bool quiet = false;
};

void add_verify_settings(Settings& settings, VerifyJob& job) {
  settings.positional("dir", job.folder, "Folder of the run").required = true;
  settings.flag("remove", job.remove,
                "Remove damaged files; 'vantage run --resume' then writes them again");
  settings.path("report", job.report, "FILE", "Write a JSON report");
  settings.flag("quiet", job.quiet, "Print errors only");
  settings.set_short_help({}, {"vantage verify results", "vantage verify results --remove",
                               "vantage verify results --report verify.json"});
}

void remove_damaged(const RunVerification& verification, const std::filesystem::path& folder) {
  for (const DamagedFile& file : verification.damaged) {
    std::error_code error;
    std::filesystem::remove(folder / file.name, error);
    if (error) {
      throw Error(
          fmt::format("{}: cannot be removed: {}", (folder / file.name).string(), error.message()));
    }
  }
}

}  // namespace

int command_verify(const Arguments& arguments) {
  VerifyJob job;
  Settings settings("verify", "Reads the results of a run and lists damaged files.");
  add_verify_settings(settings, job);
  if (!read_command_line(settings, arguments)) {
    return kExitDone;
  }
  FileChecks files(settings);
  files.add_output(job.report, "--report", OutputKind::kText);
  RunReport report(settings.command(), settings.values());
  RunJob run;
  const RunIdentity identity = read_run(job.folder, run, files);
  const SequenceLayout layout(job.folder, run.sequence);

  const RunVerification verification = report.timed_file_access("verify", [&] {
    return verify_with_progress(layout, settings.command(),
                                job.quiet ? ProgressStyle::kNone : ProgressStyle::kAuto);
  });
  if (verification.interrupted) {
    return kExitInterrupted;
  }
  report.set_results(to_value(verification));
  report.write(job.report);
  // Prints all damaged files; the error on stderr names the first.
  for (const DamagedFile& file : verification.damaged) {
    fmt::print("{} {}\n", file.name, file.problem);
  }
  if (job.remove) {
    remove_damaged(verification, job.folder);
  }
  const DeliveredFrames delivered(layout);
  const std::vector<FrameRange> missing = delivered.missing(input_frames(identity, delivered));
  if (!verification.damaged.empty() || (verification.damaged_lines > 0 && !missing.empty())) {
    const std::string damage = describe_damage(verification, job.folder);
    throw Error(identity.is_stream()
                    ? damage +
                          "; its input was standard input, so nothing but a new run writes it again"
                    : fmt::format("{}; 'vantage {}run -o {} --resume' writes it again", damage,
                                  job.remove || verification.damaged.empty()
                                      ? ""
                                      : "verify --remove' and 'vantage ",
                                  job.folder));
  }
  if (!job.quiet) {
    tell("verify: {} files with {:.1f} MB are unchanged{}\n", verification.files,
         static_cast<double>(verification.bytes) * 1e-6,
         missing.empty() || identity.is_stream()
             ? std::string()
             : fmt::format("; frames {} are not done yet", to_string(missing)));
  }
  return kExitDone;
}

}  // namespace vantage::apps
