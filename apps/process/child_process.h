#pragma once

#include <atomic>
#include <chrono>
#include <string>
#include <vector>

namespace vantage::apps {

/// How a program ended and what it printed.
struct ProgramResult {
  int exit_code = 0;  ///< 128 + the signal's number when one ended it
  std::string out;
  std::string err;
};

/// Whether a file `name` that can be executed is in a folder of PATH.
bool program_exists(const std::string& name);

/// Runs `command`, whose first member is looked for in PATH, with no input, and waits for its end.
/// Once `stop` is raised it gets a SIGTERM, and `patience` later a SIGKILL. Throws Error when it
/// cannot be started.
ProgramResult run_program(
    const std::vector<std::string>& command, const std::atomic<bool>* stop = nullptr,
    std::chrono::duration<double> patience = std::chrono::duration<double>::max());

/// From now on programs of ours that run_program() starts get a SIGTERM when this process ends,
/// however it ends. Call it on the main thread, before others start.
void end_children_with_this();
/// Does that, in the program that was started. Nothing in any other.
void end_with_parent();

/// Where this very program is, as an absolute path. Throws Error when the system does not tell.
std::string path_of_this_program();

/// `text` as one word of a POSIX shell.
std::string shell_word(const std::string& text);

}  // namespace vantage::apps
