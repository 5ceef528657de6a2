#include "apps/batch/job_runner.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <span>
#include <system_error>
#include <utility>

#include "apps/batch/batch_state.h"
#include "apps/batch/result_keeper.h"
#include "apps/batch/result_mirror.h"
#include "apps/commands/commands.h"
#include "apps/process/child_process.h"
#include "apps/run/run_session.h"
#include "engine/error.h"
#include "engine/io/files/atomic_file.h"
#include "engine/io/files/checksum.h"
#include "engine/io/files/file_descriptor.h"
#include "engine/io/files/remote_files.h"
#include "engine/sequence/journal/journal_content.h"
#include "engine/sequence/options/sequence_layout.h"
#include "scheduler/machine.h"

namespace vantage::apps {
namespace {

namespace fs = std::filesystem;

/// Of the grace, for a child to finish its frames; the rest is for what follows.
constexpr double kChildsPart = 0.75;
/// Pairs of a list are run for about so long at once: what a worker that dies loses.
constexpr double kSliceSeconds = 60;

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

/// Makes all names below `folder` durable: one call for many folders.
void flush_file_system(const fs::path& folder) {
  const FileDescriptor opened(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (!opened.valid() || ::syncfs(opened.get()) != 0) {
    throw Error(fmt::format("cannot write {}: {}", folder.string(),
                            std::generic_category().message(errno)));
  }
}

ItemResult done(int index, const ChildEnding& ending) {
  ItemResult result{.item = index};
  result.attempts = ending.attempts;
  result.seconds = ending.seconds;
  if (!ending.results.is_object()) {
    return result;
  }
  const int frames = ending.results.value("frames", 0);
  result.frames = frames + ending.results.value("frames_before", 0);
  result.core_seconds = frames * ending.core_seconds_per_frame();
  const SettingValue skipped = ending.results.value("skipped", SettingValue::array());
  result.skipped = static_cast<int>(skipped.size());
  if (!skipped.empty()) {
    result.problem = fmt::format("frame {}: {}", skipped.front().at("frame").get<int>(),
                                 skipped.front().at("text").get<std::string>());
  }
  return result;
}

/// `items` in parts of about equal size.
std::vector<std::vector<int>> slices_of(const std::vector<int>& items, double seconds) {
  const auto count = static_cast<std::size_t>(
      std::clamp(std::ceil(seconds / kSliceSeconds), 1.0, static_cast<double>(items.size())));
  std::vector<std::vector<int>> slices(count);
  for (std::size_t i = 0; i < items.size(); ++i) {
    slices[i * count / items.size()].push_back(items[i]);
  }
  return slices;
}

}  // namespace

JobRunner::JobRunner(const BatchJob& batch, const std::vector<ManifestItem>& items,
                     const SettingValue& options, ObjectStore& store, fs::path scratch,
                     const std::atomic<bool>& stop)
    : batch_(batch),
      items_(items),
      options_(options),
      store_(store),
      scratch_(std::move(scratch)),
      stop_(stop),
      is_remote_(is_address(batch.run.output)),
      children_(batch.attempts, std::chrono::duration<double>(kChildsPart * batch.grace_seconds)) {}

ItemResult JobRunner::failed(int index, const ChildEnding& ending) {
  const std::string key = fmt::format("{}failed/{:06}", BatchState::kPrefix, index);
  // It is repeated apart from the results.
  const std::string place = is_remote_ ? fmt::format("failed-{:06}", index)
                                       : (fs::path(batch_.run.output) / key).string();
  (void)store_.put_text(key + ".toml", item(index).to_job_file(place));
  ItemResult result{.item = index, .failed = true, .problem = ending.problem};
  result.attempts = ending.attempts;
  result.seconds = ending.seconds;
  result.command = fmt::format("vantage run {}",
                               shell_word(joined_path(batch_.run.output, key + ".toml").string()));
  return result;
}

ChildEnding JobRunner::run_in_scratch(const RunJob& job, const std::string& output,
                                      const std::vector<std::string>& words, const fs::path& work) {
  const SequenceLayout layout(job.output, job.sequence);
  ResultMirror mirror(store_, output + "/", layout, job.shard ? RunSession::part_name(job) : "");
  mirror.fetch();
  ResultKeeper keeper(mirror, job.output, batch_.keep_seconds, batch_.scratch_limit_bytes, stop_);
  ChildEnding ending = children_.run(words, work / "report.json", keeper.run_ends());
  try {
    keeper.finish();
    ending.is_done() ? mirror.finish() : mirror.keep();
  } catch (const Error& error) {
    ending.exit_code = kExitFailed;
    ending.problem = error.what();
  }
  std::error_code ignored;
  fs::remove_all(job.output, ignored);
  return ending;
}

std::optional<ItemResult> JobRunner::run_item(int index, const std::optional<Shard>& shard,
                                              const fs::path& work) {
  BatchItem of_item = item(index);
  const fs::path job_file = work / "job.toml";
  const std::string folder = is_remote_ ? (work / "results").string() : of_item.job().output;
  write_text_file(job_file, of_item.to_job_file(folder));
  std::vector<std::string> words = {"run", job_file.string()};
  RunJob job;
  job.output = folder;
  job.sequence = of_item.job().sequence;
  job.shard = shard;
  if (shard) {
    words.insert(words.end(), {"--shard", fmt::format("{}/{}", shard->index, shard->count)});
  }
  const ChildEnding ending = is_remote_ ? run_in_scratch(job, output_of(index), words, work)
                                        : children_.run(words, work / "report.json", stop_);
  if (ending.is_done()) {
    return done(index, ending);
  }
  return is_stopped() ? std::nullopt : std::optional(failed(index, ending));
}

std::optional<ItemResult> JobRunner::join(int index, const std::string& name) {
  const fs::path work = scratch_ / name;
  make_folder(work);
  // Its frames are done, so the whole run only joins what its parts have made.
  std::optional<ItemResult> result = run_item(index, std::nullopt, work);
  std::error_code ignored;
  fs::remove_all(work, ignored);
  return result;
}

void JobRunner::deliver(const fs::path& from, const std::string& name, const FileContent& content) {
  if (is_remote_) {
    put_result(store_, name, from, content);
    return;
  }
  const fs::path to = fs::path(batch_.run.output) / name;
  std::error_code error;
  if (fs::exists(to, error)) {
    if (file_content(to) != content) {
      throw Error(fmt::format("{}: is there already, and this batch did not make it", to.string()));
    }
    return;
  }
  fs::create_directories(to.parent_path(), error);
  if (!error) {
    fs::rename(from, to, error);
  }
  if (error) {
    throw Error(fmt::format("cannot write {}: {}", to.string(), error.message()));
  }
}

void JobRunner::take_list_results(const std::vector<int>& items, const RunJob& run,
                                  const ChildEnding& ending, std::vector<ItemResult>& results) {
  const JournalContent journal = read_journal(SequenceLayout(run.output, run.sequence));
  for (std::size_t i = 0; i < items.size(); ++i) {
    const auto record = journal.frames.find(static_cast<int>(i));
    ChildEnding of_item{.exit_code = ending.exit_code, .attempts = ending.attempts};
    of_item.seconds = ending.seconds / static_cast<double>(items.size());
    try {
      if (record == journal.frames.end() || record->second.skipped) {
        throw Error(record == journal.frames.end() ? "the run has no result of it"
                                                   : record->second.problem);
      }
      ItemResult result = done(items[i], of_item);
      result.frames = 1;
      result.core_seconds = ending.core_seconds_per_frame();
      for (const FileRecord& file : record->second.files) {
        const std::string name = output_of(items[i]) + "/" + name_of_pair(file.name).string();
        deliver(fs::path(run.output) / file.name, name, file.content);
        result.files.push_back({name, file.content});
      }
      results.push_back(std::move(result));
    } catch (const Error& error) {
      of_item.problem = error.what();
      results.push_back(failed(items[i], of_item));
    }
  }
}

void JobRunner::run_list(const std::vector<int>& items, const fs::path& work,
                         std::vector<ItemResult>& results) {
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
  BatchItem first = item(items.front());
  write_text_file(work / "job.toml", first.to_job_file_of_list((work / "pairs.csv").string(),
                                                               (work / "results").string()));
  const ChildEnding ending =
      children_.run({"run", (work / "job.toml").string()}, work / "report.json", stop_);
  if (ending.is_done()) {
    take_list_results(items, first.job(), ending, results);
    if (!is_remote_) {
      flush_file_system(batch_.run.output);  // once for all names, ahead of the results that tell
    }
  } else if (items.size() > 1 && !is_stopped()) {
    // One of them may be what ends the run.
    for (const int index : items) {
      run_list({index}, work / fmt::format("{:06}", index), results);
    }
  } else if (!is_stopped()) {
    results.push_back(failed(items.front(), ending));
  }
  std::error_code ignored;
  fs::remove_all(work, ignored);
}

void JobRunner::run(const PlannedJob& job, const std::string& name, std::vector<ItemResult>& known,
                    const std::function<void()>& on_results) {
  std::vector<int> left = job.items;
  std::erase_if(left, [&](int index) {
    return std::ranges::find(known, index, &ItemResult::item) != known.end();
  });
  const fs::path work = scratch_ / name;
  make_folder(work);
  if (job.is_list && !left.empty()) {
    const int threads = thread_count(batch_.run.common.execution, scheduler::detect_machine());
    for (const std::vector<int>& slice : slices_of(left, job.core_seconds / threads)) {
      if (!is_stopped()) {
        run_list(slice, work / "pairs", known);
        on_results();
      }
    }
  } else {
    for (const int index : left) {
      if (is_stopped()) {
        break;
      }
      if (std::optional<ItemResult> result = run_item(index, job.shard, work)) {
        known.push_back(std::move(*result));
        on_results();
      }
    }
  }
  std::error_code ignored;
  fs::remove_all(work, ignored);
}

}  // namespace vantage::apps
