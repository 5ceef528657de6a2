#include "apps/submit/task_script.h"

#include <fmt/format.h>

#include <algorithm>

#include "apps/process/child_process.h"

namespace vantage::apps {
namespace {

// The command ignores USR1 and USR2, which some engines send to all processes of a task: only this
// script knows what they mean.
constexpr std::string_view kBody = R"BASH(
set -u
failures=$folder/failures-$job

say() { echo "== $(date '+%F %T') task $task/$tasks: $*"; }

count_failures() {
  if [[ -r $failures ]]; then wc -l <"$failures"; else echo 0; fi
}
count_parts() { grep -c "^$part_line" "$finished_parts" 2>/dev/null; }

work='' stopped_by='' trapped=false
stop_before_time_limit() {
  trapped=true stopped_by=time-limit
  say "the time limit is near, finishing what is under way"
  if [[ -n $work ]]; then
    kill -TERM "$work"
    (sleep "$drain_seconds" && kill -KILL "$work") &
  fi
}
stop_for_engine() {
  trapped=true stopped_by=${stopped_by:-engine}
  if [[ -n $work ]]; then kill -INT "$work"; fi
}
trap stop_before_time_limit USR1
trap stop_for_engine "$stop_signal"

say "started on $node as job $job (earlier attempts that failed: $(count_failures))"
parts_before=$(count_parts)
(trap '' USR1 USR2 && exec "${command[@]}") &
work=$!
if [[ -n $stopped_by ]]; then kill -TERM "$work"; fi
while
  trapped=false
  wait "$work"
  code=$?
  $trapped # then it was a signal that ended the waiting
do :; done

case $code in
  0)
    say "done"
    exit 0
    ;;
  3)
    say "done, but some of it was skipped, see above"
    exit "$skipped_exit_code"
    ;;
  2)
    say "refused, see above"
    exit 2
    ;;
esac
if [[ $stopped_by == engine ]]; then
  say "stopped by $engine (exit code $code)"
  exit "$code"
fi
if [[ $stopped_by == time-limit ]]; then
  if [[ $(count_parts) -gt $parts_before ]]; then
    say "goes on in a new job"
    put_back
  fi
  say "nothing was finished within the time limit"
fi
echo "$(date '+%F %T') exit code $code on $node" >>"$failures"
if [[ $(count_failures) -le $retries ]]; then
  say "failed with exit code $code, is tried again"
  put_back
fi
say "failed with exit code $code, given up after $(count_failures) attempts"
exit "$code"
)BASH";

/// What still runs after this time is given up while there is time left to go back into the queue.
int seconds_to_kill(int drain_s) { return std::max(1, drain_s * 7 / 8); }

}  // namespace

std::string task_script(const ArrayJob& job, const ScriptDialect& dialect, const TaskWork& work,
                        std::string_view directives) {
  std::string text =
      fmt::format("#!/bin/bash\n# {} Written by 'vantage submit'.\n{}\n", work.comment, directives);
  text += fmt::format(
      "engine={}\nfolder={}\ntasks={}\nretries={}\ndrain_seconds={}\nskipped_exit_code={}\n"
      "stop_signal={}\n",
      dialect.name, shell_word(job.folder.string()), job.tasks, job.retries,
      seconds_to_kill(job.drain_s), work.skipped_exit_code, dialect.stop_signal);
  text += dialect.identity;
  text += fmt::format("command=({})\nfinished_parts={}\npart_line={}\n", work.command,
                      work.finished_parts, work.part_line);
  return text + std::string(kBody);
}

TaskWork manifest_work(const ArrayJob& job) {
  return {.comment = fmt::format("Task i does its share of a manifest, i of {}.", job.tasks),
          .command = shell_line(job.command),
          .finished_parts = "$folder/task-$task.log",
          .part_line = "'batch: job '",
          .skipped_exit_code = 3};
}

std::string shell_line(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) {
    text += (text.empty() ? "" : " ") + shell_word(word);
  }
  return text;
}

}  // namespace vantage::apps
