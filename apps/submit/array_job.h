#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace vantage::apps {

/// A number of tasks that differ in their index alone: what every engine is asked for. Requests
/// that are empty leave the choice to the engine.
struct ArrayJob {
  std::string name;                         ///< lower-case letters, digits and "-"
  std::filesystem::path folder;             ///< of scripts and logs, absolute
  std::vector<std::string> command;         ///< words; the index is in the environment of a task
  int tasks = 1;                            ///< at least 1
  std::optional<int> concurrent;            ///< tasks at a time
  std::optional<int> cores;                 ///< of a task; of a manifest never empty
  std::optional<std::size_t> memory_bytes;  ///< of a task; of a manifest never empty
  std::optional<long> time_limit_s;         ///< of a task
  int drain_s = 0;                          ///< from the signal to end until a task is killed
  int retries = 2;                          ///< further attempts after a task has failed
};

/// What an engine takes: files, which belong in ArrayJob::folder, and the commands, as words, that
/// hand them over.
struct Submission {
  struct File {
    std::string name;
    std::string text;
  };
  std::vector<File> files;
  std::vector<std::vector<std::string>> commands;
};

/// The name of a job with results in `output`: "vantage-" and what engines take of its last part.
std::string job_name(const std::filesystem::path& output);

/// In whole units of 1024² bytes, rounded up.
constexpr std::size_t mebibytes(std::size_t bytes) { return (bytes + (1 << 20) - 1) >> 20; }

}  // namespace vantage::apps
