#include <sys/wait.h>

#include <cstdlib>

#include "tests/apps/sampling.h"

namespace vantage::command_submit_test {

/// Exit code of a shell command; its output goes to `log`.
int shell(const std::string& command, const std::string& log) {
  const std::string line = "{ " + command + "\n} >>'" + log + "' 2>&1";
  const int status = std::system(line.c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

/// Puts programs of a test's own in front of those of the system.
class SubmitCommand : public DotFramesTest {
 protected:
  SubmitCommand() {
    fs::create_directory(programs_);
    ::setenv("PATH", (programs_ + ":" + path_).c_str(), 1);
    add_program("sbatch", "echo 4$(wc -l <" + calls_ + ")");
    add_program("squeue", "exit 1");
    add_program("scancel", "");
    add_program("scontrol", "");
  }
  ~SubmitCommand() override { ::setenv("PATH", path_.c_str(), 1); }

  /// A shell script that also notes how it was called.
  void add_program(const std::string& name, const std::string& body) const {
    const std::string file = programs_ + "/" + name;
    write_file(file, "#!/bin/bash\necho \"" + name + " $*\" >>" + calls_ + "\n" + body + "\n");
    fs::permissions(file, fs::perms::owner_all);
  }
  [[nodiscard]] std::string calls() const { return read_file(calls_); }

  [[nodiscard]] Words run_options(const std::string& out) const {
    return {"--left",         left_, "--right", right_, "-o", out, "--disparities=0:9",
            "--chunk-frames", "2"};
  }
  /// Writes the scripts.
  [[nodiscard]] ProcessResult write(const std::string& out, const Words& more = {}) const {
    const Words submit = words("submit --engine slurm --shards 3");
    return run_vantage(joined(joined(submit, run_options(out)), more));
  }
  [[nodiscard]] ProcessResult submit(const std::string& out, const Words& more = {}) const {
    return write(out, joined({"--go"}, more));
  }
  static std::string slurm(const std::string& out, const std::string& file) {
    return out + "/.vantage/slurm/" + file;
  }

  /// Runs the script of a task that has been submitted to `out`, and `meanwhile`, which knows the
  /// script as $task.
  [[nodiscard]] static int run_task(const std::string& out, const std::string& meanwhile = "") {
    return shell("SLURM_ARRAY_JOB_ID=41 SLURM_ARRAY_TASK_ID=2 SLURM_CPUS_ON_NODE=5 bash '" +
                     slurm(out, "array.sh") + "' &\ntask=$!\n" + meanwhile + "\nwait $task",
                 slurm(out, "task-2.log"));
  }
  /// A vantage that says "ready" and goes on until TERM or INT; then it notes a finished frame in
  /// `frames` and ends, unless it `stays`.
  void add_patient_vantage(const std::string& frames, bool stays = false) const {
    // Not in bash: it cannot catch INT when it has been started with INT ignored.
    const std::string at_signal =
        "(open('" + frames + "', 'a').write('{}\\n')," + (stays ? "0" : "sys.exit(130)") + ")";
    add_program("vantage",
                "exec python3 -c \"import signal, sys, time\nfor s in (signal.SIGINT, "
                "signal.SIGTERM): signal.signal(s, lambda *_: " +
                    at_signal + ")\nopen('" + folder_ / "ready" + "', 'w')\ntime.sleep(60)\"");
  }
  [[nodiscard]] std::string send_when_ready(const std::string& signal) const {
    return "for wait in $(seq 1000); do [ -e " + folder_ / "ready" +
           " ] && break; sleep 0.02; done; kill -" + signal + " $task";
  }

  std::string programs_ = folder_ / "programs";
  std::string calls_ = folder_ / "calls";
  std::string path_ = std::getenv("PATH");
};

TEST_F(SubmitCommand, TheJobFileHoldsTheWholeRunWithAbsolutePaths) {
  const fs::path start = fs::current_path();
  fs::current_path(folder_.path());
  const ProcessResult result =
      run_vantage(words("submit --left left --right right/*.png -o out --shards 1 --mu 0.3 "
                        "--keep-going --disparities=0:9"));
  fs::current_path(start);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const std::string out = folder_ / "out";
  EXPECT_THAT(files_below(out),
              ElementsAre(".vantage/slurm/array.sh", ".vantage/slurm/job.toml",
                          ".vantage/slurm/merge.sh", ".vantage/slurm/submit.toml"));
  const ProcessResult of_file =
      succeeds(run_vantage({"run", slurm(out, "job.toml"), "--print-config"}));
  EXPECT_EQ(of_file.out,
            run_vantage({"run", "--left", left_, "--right", right_ + "/*.png", "-o", out, "--mu",
                         "0.3", "--keep-going", "--disparities=0:9", "--print-config"})
                .out);
  EXPECT_EQ(run_vantage({"submit", "--config", slurm(out, "submit.toml"), "--print-config"}).out,
            read_file(slurm(out, "submit.toml")));
  EXPECT_EQ(calls(), "");
  EXPECT_THAT(result.out, HasSubstr("sbatch --parsable " + slurm(out, "array.sh")));
}

TEST_F(SubmitCommand, FewFramesAreDividedAmongAllTasks) {
  const std::string out = folder_ / "out";
  const ProcessResult result =
      succeeds(run_vantage({"submit", "--engine", "slurm", "--shards", "3", "--left", left_,
                            "--right", right_, "--disparities=0:9", "-o", out}));
  EXPECT_THAT(result.err, HasSubstr("--chunk-frames is "));
  for (const char* file : {"job.toml", "submit.toml"}) {
    EXPECT_THAT(read_file(slurm(out, file)), Not(HasSubstr("chunk-frames = 50")));
  }
}

TEST_F(SubmitCommand, OptionsBecomeDirectives) {
  const std::string out = folder_ / "an 'odd' 50% folder";
  succeeds(write(
      out,
      words("--partition long --account film --time 1-12 --cpus 16 --task-memory 8G "
            "--concurrent 2 --sbatch-option --qos=low --sbatch-option --constraint=avx2 --program "
            "/opt/vantage")));
  const std::string array = read_file(slurm(out, "array.sh"));
  for (const std::string& directive :
       words("--array=1-3%2 --partition=long --account=film --time=1-12:00:00 --cpus-per-task=16 "
             "--mem=8192M --qos=low --constraint=avx2 --signal=B:USR1@120 --requeue "
             "--open-mode=append")) {
    EXPECT_THAT(array, HasSubstr("\n#SBATCH " + directive + "\n"));
  }
  EXPECT_THAT(array, HasSubstr("an 'odd' 50%% folder/.vantage/slurm/task-%a.log\"\n"));
  EXPECT_THAT(array, HasSubstr("\ncommand=(/opt/vantage run "));
  const std::string merge = read_file(slurm(out, "merge.sh"));
  EXPECT_THAT(merge, HasSubstr("\n#SBATCH --partition=long\n"));
  EXPECT_THAT(merge, Not(HasSubstr("cpus-per-task")));
  EXPECT_THAT(merge, HasSubstr("exec /opt/vantage merge '"));
  EXPECT_EQ(shell("bash -n '" + slurm(folder_ / "an '\\''odd'\\'' 50% folder", "array.sh") + "'",
                  folder_ / "log"),
            0);
  // A short time limit leaves less time to finish; --threads are processors unless told otherwise.
  succeeds(write(out, {"--time", "4", "--threads", "3"}));
  EXPECT_THAT(read_file(slurm(out, "array.sh")), HasSubstr("--signal=B:USR1@60\n"));
  EXPECT_THAT(read_file(slurm(out, "array.sh")), HasSubstr("--cpus-per-task=3\n"));
  EXPECT_THAT(read_file(slurm(out, "array.sh")), Not(HasSubstr("--threads")));
}

TEST_F(SubmitCommand, SubmitsTheArrayAndTheMergeAfterIt) {
  const std::string out = folder_ / "out";
  const ProcessResult result = succeeds(submit(out));
  EXPECT_EQ(calls(), "sbatch --parsable " + slurm(out, "array.sh") +
                         "\nsbatch --parsable --dependency=afterok:41 --kill-on-invalid-dep=yes " +
                         slurm(out, "merge.sh") + "\n");
  const auto jobs = read_json(slurm(out, "submitted.json"));
  EXPECT_EQ(jobs, (nlohmann::json{{"array_job", "41"}, {"merge_job", "42"}}));
  for (const std::string says :
       {"squeue --array --jobs=41,42", "scancel 41 42", "*.log", "vantage submit --go --config"}) {
    EXPECT_THAT(result.out, HasSubstr(says));
  }
  EXPECT_EQ(submit(out, {"--quiet"}).out, "");
  EXPECT_THAT(read_file(slurm(out, "job.toml")), HasSubstr("quiet = false"));

  add_program("squeue", "echo running");
  expect_one_line(submit(out), 1, "submit", "still in the queue");
}

TEST_F(SubmitCommand, WhatSlurmRefusesIsOneLine) {
  const std::string out = folder_ / "out";
  add_program("sbatch", "echo 'sbatch: error: no such thing' >&2; echo 'really' >&2; exit 1");
  expect_one_line(submit(out), 1, "submit", "no such thing really");
  EXPECT_THAT(calls(), Not(HasSubstr("scancel")));

  // An array without its merge must not stay.
  add_program("sbatch", "[[ $* == *array.sh ]] && echo '41;cluster' || exit 1");
  expect_one_line(submit(out), 1, "submit");
  EXPECT_THAT(calls(), HasSubstr("afterok:41 "));
  EXPECT_THAT(calls(), HasSubstr("scancel 41"));
  EXPECT_FALSE(fs::exists(slurm(out, "submitted.json")));

  add_program("sbatch", "echo 'good morning'");
  EXPECT_THAT(submit(out).err, HasSubstr("expected a job number"));

  ::setenv("PATH", (folder_ / "nothing").c_str(), 1);
  expect_one_line(submit(folder_ / "other"), 1, "submit", "sbatch is not in the PATH");
  EXPECT_FALSE(fs::exists(folder_ / "other"));
}

using InputSubmitCommand = SubmitCommand;

TEST_F(InputSubmitCommand, WrongUsageIsOneLineAndExit2) {
  const std::vector<Refusal> refusals = {
      {{"--shard", "1/3"}, "--shard cannot be submitted"},
      {{"--dry-run"}, "--dry-run cannot be submitted"},
      {{"--report", "r.json"}, "--report cannot be submitted"},
      {{"--time", "1:2:3:4"}, "--time is '1:2:3:4'"},
      {{"--time", "0"}, "--time is '0'"},
      {{"--task-memory", "8X"}, "--task-memory is '8X'"},
      {{"--sbatch-option", "qos"}, "--sbatch-option is 'qos'"},
      {{"--sbatch-option", "--a\nb"}, "--sbatch-option is"},
      {{"--partition", "a b"}, "--partition is 'a b'"},
      {{"--cpus", "0"}, "--cpus is 0"},
      {{"--concurrent", "0"}, "--concurrent is 0"},
      {{"--retries", "-1"}, "--retries is -1"},
      {{"--drain-time", "0"}, "--drain-time is 0"},
      {{"--engine", "pbs"}, "--engine"},
      {{"--chunk-frames", "4"}, "--chunk-frames is given 2 times"},
      {{"--frames", "0-3"}, "--shards is 3, expected at most 2: there are 4 frames"},
      {{"--window", "4"}, "window is 4"},
      {{"--left", right_}, "--left is given 2 times"}};
  const std::string out = folder_ / "out";
  expect_refusals("submit", folder_.path(), refusals,
                  [&](const Words& words) { return submit(out, words); });
  const ProcessResult undivided =
      run_vantage({"submit", "--engine", "slurm", "--left", left_, "--right", right_, "-o", out});
  EXPECT_EQ(undivided.exit_code, 2);
  EXPECT_EQ(undivided.err, "vantage submit: --shards is missing, expected --shards N\n");
  expect_one_line(write(out, {"--overwrite"}), 2, "submit", "--overwrite cannot be submitted");
  EXPECT_FALSE(fs::exists(out));
  EXPECT_EQ(submit(folder_ / "a\"b").exit_code, 2);
  EXPECT_EQ(calls(), "");

  write_file(folder_ / "file", "not a folder");
  expect_one_line(submit(folder_ / "file"), 1, "submit");
}

TEST_F(SubmitCommand, TheFolderOfAnotherRunIsRefused) {
  const std::string out = folder_ / "out";
  succeeds(run_vantage(joined({"run", "--quiet"}, run_options(out))));
  succeeds(submit(out));
  expect_one_line(submit(out, {"--iterations", "2"}), 1, "submit", "iterations");
  succeeds(submit(out, {"--iterations", "2", "--overwrite"}));
  // Only the submission begins anew, not its tasks nor its repetition.
  EXPECT_THAT(read_file(slurm(out, "job.toml")), HasSubstr("overwrite = false"));
  EXPECT_THAT(read_file(slurm(out, "submit.toml")), HasSubstr("overwrite = false"));
}

TEST_F(SubmitCommand, TasksMakeTheShardsOfTheRun) {
  const std::string out = folder_ / "out";
  const std::string whole = folder_ / "whole";
  succeeds(run_vantage(joined({"run", "--quiet"}, run_options(whole))));
  succeeds(submit(out));
  for (const std::string task : {"3", "1", "2"}) {
    EXPECT_EQ(shell("SLURM_ARRAY_JOB_ID=41 SLURM_ARRAY_TASK_ID=" + task + " bash '" +
                        slurm(out, "array.sh") + "'",
                    folder_ / "log"),
              0)
        << read_file(folder_ / "log");
  }
  EXPECT_EQ(shell("bash '" + slurm(out, "merge.sh") + "'", folder_ / "log"), 0)
      << read_file(folder_ / "log");
  for (const std::string& file : files_below(whole + "/disparity")) {
    EXPECT_EQ(read_file(out + "/disparity/" + file), read_file(whole + "/disparity/" + file));
  }
  EXPECT_EQ(files_below(out + "/disparity"), files_below(whole + "/disparity"));
  EXPECT_THAT(files_below(out + "/.vantage/slurm"),
              IsSupersetOf({"report-1.json", "report-2.json", "report-3.json"}));
}

TEST_F(SubmitCommand, ATaskEndsAsItsRunDoes) {
  const std::string out = folder_ / "out";
  succeeds(submit(out, {"--program", programs_ + "/vantage", "--frames", "0-5"}));
  add_program("vantage", "exit 0");
  EXPECT_EQ(run_task(out), 0);
  EXPECT_THAT(calls(), HasSubstr("vantage run " + slurm(out, "job.toml") +
                                 " --shard 2/3 --resume --progress plain --report " +
                                 slurm(out, "report-2.json") + " --threads 5\n"));
  add_program("vantage", "exit 3");
  EXPECT_EQ(run_task(out), 0);
  EXPECT_THAT(read_file(slurm(out, "task-2.log")), HasSubstr("some of it was skipped"));
  add_program("vantage", "exit 2");
  EXPECT_EQ(run_task(out), 2);
  EXPECT_THAT(calls(), Not(HasSubstr("scontrol")));
}

TEST_F(SubmitCommand, AFailedTaskIsTriedAgainAndThenGivenUp) {
  const std::string out = folder_ / "out";
  succeeds(submit(out, {"--program", programs_ + "/vantage", "--retries", "1"}));
  add_program("vantage", "kill -SEGV $$");
  EXPECT_EQ(run_task(out), 0);
  EXPECT_THAT(calls(), HasSubstr("scontrol requeue 41_2\n"));
  EXPECT_THAT(read_file(slurm(out, "task-2.log")), HasSubstr("exit code 139, is tried again"));
  fs::remove(calls_);
  EXPECT_EQ(run_task(out), 139);
  EXPECT_THAT(calls(), Not(HasSubstr("scontrol")));
  EXPECT_THAT(read_file(slurm(out, "task-2.log")), HasSubstr("given up after 2 attempts"));

  // A later submission starts counting anew; Slurm may refuse, though.
  add_program("scontrol", "exit 1");
  fs::remove(slurm(out, "failures-41_2"));
  EXPECT_EQ(run_task(out), 1);
  EXPECT_THAT(read_file(slurm(out, "task-2.log")), HasSubstr("cannot be put back"));
}

TEST_F(SubmitCommand, ATaskContinuesAfterItsTimeLimitIfItGotAnythingDone) {
  const std::string out = folder_ / "out";
  succeeds(submit(out, {"--program", programs_ + "/vantage", "--retries", "0"}));
  const std::string frames = out + "/.vantage/frames-2-of-3.jsonl";
  add_patient_vantage(frames);
  EXPECT_EQ(run_task(out, send_when_ready("USR1")), 0);
  EXPECT_THAT(calls(), HasSubstr("scontrol requeue 41_2\n"));
  fs::remove(calls_);
  fs::remove(folder_ / "ready");
  add_patient_vantage("/dev/null");
  EXPECT_EQ(run_task(out, send_when_ready("USR1")), 130);
  EXPECT_THAT(calls(), Not(HasSubstr("scontrol")));
  EXPECT_THAT(read_file(slurm(out, "task-2.log")), HasSubstr("nothing was finished"));
}

TEST_F(SubmitCommand, FramesThatDoNotEndInTimeAreGivenUp) {
  const std::string out = folder_ / "out";
  succeeds(
      submit(out, {"--program", programs_ + "/vantage", "--drain-time", "1", "--frames", "0-5"}));
  add_patient_vantage(out + "/.vantage/frames-frames-0-5-2-of-3.jsonl", true);
  EXPECT_EQ(run_task(out, send_when_ready("USR1")), 0);
  EXPECT_THAT(read_file(slurm(out, "task-2.log")), HasSubstr("goes on in a new job"));
  EXPECT_THAT(calls(), HasSubstr("scontrol requeue 41_2\n"));
}

TEST_F(SubmitCommand, ACancelledTaskStaysCancelled) {
  const std::string out = folder_ / "out";
  succeeds(submit(out, {"--program", programs_ + "/vantage"}));
  add_patient_vantage("/dev/null");
  EXPECT_EQ(run_task(out, send_when_ready("TERM")), 130);
  EXPECT_THAT(calls(), Not(HasSubstr("scontrol")));
  EXPECT_THAT(read_file(slurm(out, "task-2.log")), HasSubstr("stopped by Slurm"));
}

}  // namespace vantage::command_submit_test
