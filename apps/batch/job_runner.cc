#include "apps/batch/job_runner.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "apps/commands/commands.h"
#include "apps/process/child_process.h"
#include "engine/error.h"
#include "engine/io/files/atomic_file.h"
#include "engine/io/files/checksum.h"
#include "engine/io/files/json_text.h"
#include "engine/io/files/remote_files.h"
#include "engine/options/match_settings.h"
#include "engine/seconds_since.h"
#include "engine/sequence/journal/journal_content.h"
#include "engine/sequence/options/sequence_layout.h"

namespace vantage::apps {
namespace {

namespace fs = std::filesystem;

/// Of the grace, for a child to finish its frames; the rest is for what follows.
constexpr double kChildsPart = 0.75;
constexpr std::chrono::milliseconds kFirstPause{200};

/// The last line that is no blank one, without "vantage run: ".
std::string last_line(const std::string& text) {
  const std::size_t end = text.find_last_not_of(" \n\r\t");
  if (end == std::string::npos) {
    return "";
  }
  const std::size_t newline = text.find_last_of('\n', end);
  const std::size_t begin = newline == std::string::npos ? 0 : newline + 1;
  const std::string line = text.substr(begin, end + 1 - begin);
  for (const std::string_view prefix : {"vantage run: ", "vantage merge: "}) {
    if (line.starts_with(prefix)) {
      return line.substr(prefix.size());
    }
  }
  return line;
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

/// One field of CSV.
std::string csv_field(const std::string& text) {
  std::string field = "\"";
  for (const char letter : text) {
    field += letter == '"' ? std::string("\"\"") : std::string(1, letter);
  }
  return field + "\"";
}

/// "disparity/000003.pfm" of a list is "disparity.pfm" of a pair.
fs::path name_of_pair(const fs::path& name) {
  return fs::path(name.parent_path()) += name.extension();
}

/// Gives a file its final place; Error where another file is there.
void move_into_place(const fs::path& from, const fs::path& to, const FileContent& content) {
  std::error_code error;
  if (fs::exists(to, error)) {
    if (file_content(to) != content) {
      throw Error(fmt::format("{}: is there already, and this batch did not make it", to.string()));
    }
    fs::remove(from, error);
    return;
  }
  make_folder(to.parent_path());
  fs::rename(from, to, error);
  if (error) {
    throw Error(fmt::format("cannot write {}: {}", to.string(), error.message()));
  }
}

double sum_of(const SettingValue& values) {
  double sum = 0;
  for (const auto& [step, seconds] : values.items()) {
    sum += seconds.get<double>();
  }
  return sum;
}

}  // namespace

JobRunner::JobRunner(const BatchJob& batch, const std::vector<ManifestItem>& items,
                     const SettingValue& options, const std::atomic<bool>& stop)
    : batch_(batch),
      items_(items),
      options_(options),
      stop_(stop),
      state_(fs::path(batch.run.output) / ".vantage" / "batch"),
      program_(path_of_this_program()) {}

JobRunner::Ending JobRunner::run_child(const std::vector<std::string>& words,
                                       const fs::path& report) const {
  std::error_code ignored;
  fs::remove(report, ignored);
  std::vector<std::string> command = {program_};
  command.insert(command.end(), words.begin(), words.end());
  command.insert(command.end(), {"--report", report.string()});
  const auto start = std::chrono::steady_clock::now();
  const ProgramResult result = run_program(
      command, &stop_, std::chrono::duration<double>(kChildsPart * batch_.grace_seconds));
  Ending ending{.exit_code = result.exit_code,
                .problem = text_of_ending(result.exit_code, result.err),
                .seconds = seconds_since(start)};
  if (fs::exists(report, ignored)) {
    ending.results = read_json_file(report).value("results", SettingValue());
  }
  return ending;
}

JobRunner::Ending JobRunner::try_child(const std::vector<std::string>& words,
                                       const fs::path& report) const {
  auto pause = kFirstPause;
  for (int attempt = 1;; ++attempt) {
    Ending ending = run_child(words, report);
    ending.attempts = attempt;
    const int code = ending.exit_code;
    // Wrong usage stays wrong, and some frames may be bad.
    const bool is_over = code == kExitDone || code == kExitSkipped || code == kExitUsage;
    if (is_over || is_stopped() || attempt == batch_.attempts) {
      return ending;
    }
    std::this_thread::sleep_for(pause);
    pause *= 2;
  }
}

ItemResult JobRunner::failed(int index, const Ending& ending) const {
  const fs::path folder = state_ / "failed";
  const std::string place = (folder / fmt::format("{:06}", index)).string();
  make_folder(folder);
  write_text_file(place + ".toml", item(index).to_job_file(place));
  ItemResult result{.item = index, .failed = true, .problem = ending.problem};
  result.attempts = ending.attempts;
  result.seconds = ending.seconds;
  result.command = fmt::format("vantage run {}", shell_word(place + ".toml"));
  return result;
}

ItemResult JobRunner::done(int index, const Ending& ending) const {
  ItemResult result{.item = index};
  result.attempts = ending.attempts;
  result.seconds = ending.seconds;
  if (!ending.results.is_object()) {
    return result;
  }
  const int frames = ending.results.value("frames", 0);
  result.frames = frames + ending.results.value("frames_before", 0);
  const SettingValue skipped = ending.results.value("skipped", SettingValue::array());
  result.skipped = static_cast<int>(skipped.size());
  if (!skipped.empty() && skipped.front().is_object()) {
    result.problem = fmt::format("frame {}: {}", skipped.front().value("frame", 0),
                                 skipped.front().value("text", ""));
  }
  result.core_seconds =
      frames * sum_of(ending.results.value("processor_seconds_per_frame", SettingValue::object()));
  return result;
}

std::optional<ItemResult> JobRunner::run_item(int index, const std::optional<Shard>& shard,
                                              const fs::path& work) const {
  const fs::path job_file = work / "job.toml";
  BatchItem of_item = item(index);
  write_text_file(job_file, of_item.to_job_file(of_item.job().output));
  std::vector<std::string> words = {"run", job_file.string()};
  if (shard) {
    words.insert(words.end(), {"--shard", fmt::format("{}/{}", shard->index, shard->count)});
  }
  return result_of(index, try_child(words, work / "report.json"));
}

std::optional<ItemResult> JobRunner::result_of(int index, const Ending& ending) const {
  if (ending.exit_code == kExitDone || ending.exit_code == kExitSkipped) {
    return done(index, ending);
  }
  return is_stopped() ? std::nullopt : std::optional(failed(index, ending));
}

std::optional<ItemResult> JobRunner::merge(int index) {
  const fs::path work = state_ / "work" / fmt::format("merge-{:06}", index);
  make_folder(work);
  const Ending ending =
      try_child({"merge", item(index).job().output, "--quiet"}, work / "report.json");
  std::error_code ignored;
  fs::remove_all(work, ignored);
  return result_of(index, ending);
}

void JobRunner::take_list_results(const std::vector<int>& items, const RunJob& run,
                                  const Ending& ending, std::vector<ItemResult>& results) const {
  const JournalContent journal = read_journal(SequenceLayout(run.output, run.sequence));
  for (std::size_t i = 0; i < items.size(); ++i) {
    const auto record = journal.frames.find(static_cast<int>(i));
    Ending of_item = ending;
    of_item.seconds /= static_cast<double>(items.size());
    if (record == journal.frames.end() || record->second.skipped) {
      of_item.problem =
          record == journal.frames.end() ? "the run has no result of it" : record->second.problem;
      results.push_back(failed(items[i], of_item));
      continue;
    }
    of_item.results = nullptr;
    ItemResult result = done(items[i], of_item);
    result.frames = 1;
    const fs::path output = items_[static_cast<std::size_t>(items[i])].output;
    try {
      for (const FileRecord& file : record->second.files) {
        const fs::path name = output / name_of_pair(file.name);
        move_into_place(fs::path(run.output) / file.name, fs::path(batch_.run.output) / name,
                        file.content);
        result.files.push_back({name.string(), file.content});
      }
      if (ending.results.is_object()) {
        result.core_seconds =
            sum_of(ending.results.value("processor_seconds_per_frame", SettingValue::object()));
      }
      results.push_back(std::move(result));
    } catch (const Error& error) {
      of_item.problem = error.what();
      results.push_back(failed(items[i], of_item));
    }
  }
}

void JobRunner::run_list(const std::vector<int>& items, const fs::path& work,
                         std::vector<ItemResult>& results) const {
  std::string list = "left,right,min-disparity,max-disparity\n";
  for (const int index : items) {
    const BatchItem of_item = item(index);
    const RunJob& job = of_item.job();
    const MatchOptions& match = job.sequence.match;
    list += fmt::format("{},{},{}\n", csv_field(absolute_path(job.input.left).string()),
                        csv_field(absolute_path(job.input.right).string()),
                        match.disparities_auto
                            ? ","
                            : fmt::format("{},{}", match.disparities.min, match.disparities.max));
  }
  make_folder(work);
  write_text_file(work / "pairs.csv", list);
  const std::string output = (work / "results").string();
  BatchItem first = item(items.front());
  write_text_file(work / "job.toml",
                  first.to_job_file_of_list((work / "pairs.csv").string(), output));
  const Ending ending = try_child({"run", (work / "job.toml").string()}, work / "report.json");
  if (ending.exit_code == kExitDone || ending.exit_code == kExitSkipped) {
    take_list_results(items, first.job(), ending, results);
  } else if (items.size() > 1 && !is_stopped()) {
    // One of them may be what ends the run.
    for (const int index : items) {
      run_list({index}, work / fmt::format("{:06}", index), results);
    }
  } else if (!is_stopped()) {
    results.push_back(failed(items.front(), ending));
  }
}

void JobRunner::run(const PlannedJob& job, const std::string& name, std::vector<ItemResult>& known,
                    const std::function<void()>& on_results) {
  std::vector<int> left = job.items;
  std::erase_if(left, [&](int index) {
    return std::ranges::find(known, index, &ItemResult::item) != known.end();
  });
  const fs::path work = state_ / "work" / name;
  make_folder(work);
  if (job.is_list && !left.empty()) {
    run_list(left, work, known);
    on_results();
  }
  for (const int index : job.is_list ? std::vector<int>() : left) {
    if (std::optional<ItemResult> result = run_item(index, job.shard, work)) {
      known.push_back(std::move(*result));
      on_results();
    }
    if (is_stopped()) {
      return;
    }
  }
  if (!is_stopped()) {
    std::error_code ignored;
    fs::remove_all(work, ignored);
  }
}

}  // namespace vantage::apps
