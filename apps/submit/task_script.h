#pragma once

#include <string>
#include <string_view>

#include "apps/submit/array_job.h"

namespace vantage::apps {

/// How an engine starts and ends the tasks of a script, in bash.
struct ScriptDialect {
  std::string_view name;  ///< in messages
  /// Lines that set `task` (from 1), `job` (name of the task, the same after a restart) and `node`,
  /// and define `put_back`, which puts the task back into the queue and ends this attempt. They may
  /// use `folder`.
  std::string_view identity;
  /// What the engine sends to a task that has to end, without going back by itself. USR1 announces
  /// the time limit.
  std::string_view stop_signal;
};

/// What a task does, in words of bash that may use `task`, `tasks` and `folder`.
struct TaskWork {
  std::string comment;  ///< what task i makes
  std::string command;
  /// A file that gets a line for each finished part, and how these lines begin: after the time
  /// limit a task goes on as long as there are more of them each time.
  std::string finished_parts;
  std::string part_line;
  int skipped_exit_code = 0;  ///< of a task that is done but for parts that failed for good
};

/// A script for all tasks of an array: starts the command, ends it in time, and judges its exit
/// code: 0 and 3 done, 2 never again, any other again up to ArrayJob::retries times.
/// `directives` are lines for the engine.
std::string task_script(const ArrayJob& job, const ScriptDialect& dialect, const TaskWork& work,
                        std::string_view directives);

/// The work of a task of a manifest: ArrayJob::command.
TaskWork manifest_work(const ArrayJob& job);

/// `words` as a line of a POSIX shell.
std::string shell_line(const std::vector<std::string>& words);

}  // namespace vantage::apps
