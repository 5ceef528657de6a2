#include "apps/batch/child_run.h"

#include <fmt/format.h>

#include <system_error>
#include <thread>

#include "apps/commands/commands.h"
#include "apps/process/child_process.h"
#include "engine/io/files/json_text.h"
#include "engine/seconds_since.h"

namespace vantage::apps {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::milliseconds kFirstPause{200};

/// The last line that is no blank one, without "vantage run: ".
std::string last_line(const std::string& text) {
  constexpr std::string_view kPrefix = "vantage run: ";
  const std::size_t end = text.find_last_not_of(" \n\r\t");
  if (end == std::string::npos) {
    return "";
  }
  const std::size_t newline = text.find_last_of('\n', end);
  const std::size_t begin = newline == std::string::npos ? 0 : newline + 1;
  const std::string line = text.substr(begin, end + 1 - begin);
  return line.starts_with(kPrefix) ? line.substr(kPrefix.size()) : line;
}

std::string text_of_ending(int exit_code, const std::string& err) {
  constexpr int kSignals = 128;
  const std::string line = last_line(err);
  if (exit_code > kSignals && exit_code != kExitInterrupted) {
    return fmt::format("ended by signal {}{}{}", exit_code - kSignals, line.empty() ? "" : ": ",
                       line);
  }
  return line.empty() ? fmt::format("exit code {}", exit_code) : line;
}

}  // namespace

bool ChildEnding::is_done() const { return exit_code == kExitDone || exit_code == kExitSkipped; }

double ChildEnding::core_seconds_per_frame() const {
  double sum = 0;
  if (results.is_object() && results.contains("processor_seconds_per_frame")) {
    for (const auto& [step, seconds_of_step] : results["processor_seconds_per_frame"].items()) {
      sum += seconds_of_step.get<double>();
    }
  }
  return sum;
}

ChildRuns::ChildRuns(int attempts, std::chrono::duration<double> patience)
    : attempts_(attempts), patience_(patience), program_(path_of_this_program()) {}

ChildEnding ChildRuns::run_once(const std::vector<std::string>& words, const fs::path& report,
                                const std::atomic<bool>& stop) const {
  std::error_code ignored;
  fs::remove(report, ignored);
  std::vector<std::string> command = {program_};
  command.insert(command.end(), words.begin(), words.end());
  command.insert(command.end(), {"--report", report.string()});
  const auto start = std::chrono::steady_clock::now();
  const ProgramResult result = run_program(command, &stop, patience_);
  ChildEnding ending{.exit_code = result.exit_code,
                     .problem = text_of_ending(result.exit_code, result.err),
                     .seconds = seconds_since(start)};
  if (fs::exists(report, ignored)) {
    ending.results = read_json_file(report).value("results", SettingValue());
  }
  return ending;
}

ChildEnding ChildRuns::run(const std::vector<std::string>& words, const fs::path& report,
                           const std::atomic<bool>& stop) const {
  auto pause = kFirstPause;
  for (int attempt = 1;; ++attempt) {
    ChildEnding ending = run_once(words, report, stop);
    ending.attempts = attempt;
    // Wrong usage stays wrong.
    if (ending.is_done() || ending.exit_code == kExitUsage || stop.load() || attempt == attempts_) {
      return ending;
    }
    std::this_thread::sleep_for(pause);
    pause *= 2;
  }
}

}  // namespace vantage::apps
