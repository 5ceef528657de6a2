#include "tests/apps/vantage_process.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>

#include "tests/test_paths.h"

namespace vantage {
namespace {

/// As exec wants them; ends with null.
std::vector<char*> pointers(Words& texts) {
  std::vector<char*> all;
  for (std::string& text : texts) {
    all.push_back(text.data());
  }
  all.push_back(nullptr);
  return all;
}

std::string name_of(const std::string& variable) { return variable.substr(0, variable.find('=')); }

Words with_changes(char** variables, const Words& changes) {
  Words all = changes;
  for (; *variables != nullptr; ++variables) {
    const std::string name = name_of(*variables);
    if (std::ranges::none_of(changes, [&](const auto& other) { return name_of(other) == name; })) {
      all.emplace_back(*variables);
    }
  }
  return all;
}

}  // namespace

VantageProcess::VantageProcess(const Words& arguments, const fs::path& folder,
                               const Words& environment)
    : out_(folder / "stdout"), err_(folder / "stderr") {
  const std::string binary = test_paths::vantage_binary();
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  constexpr int kFlags = O_CREAT | O_TRUNC | O_WRONLY;
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, out_.c_str(), kFlags, 0600);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, err_.c_str(), kFlags, 0600);
  Words texts = {binary};
  texts.insert(texts.end(), arguments.begin(), arguments.end());
  Words changes = environment;
  if (std::ranges::none_of(changes, [](const std::string& variable) {
        return name_of(variable) == "XDG_CONFIG_HOME";
      })) {
    // What whoever runs the tests has tuned is not to be found.
    changes.push_back("XDG_CONFIG_HOME=" + (fs::absolute(folder) / "config").string());
  }
  Words variables = with_changes(environ, changes);
  const int error = posix_spawn(&pid_, binary.c_str(), &actions, nullptr, pointers(texts).data(),
                                pointers(variables).data());
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) {
    throw std::runtime_error("cannot start " + binary);
  }
}

void VantageProcess::send(int signal) const { ::kill(pid_, signal); }

bool VantageProcess::has_ended() const {
  siginfo_t info{};
  return ::waitid(P_PID, static_cast<id_t>(pid_), &info, WEXITED | WNOHANG | WNOWAIT) == 0 &&
         info.si_pid != 0;
}

std::string VantageProcess::err() const { return read_file(err_); }

ProcessResult VantageProcess::wait() const {
  int status = 0;
  ::waitpid(pid_, &status, 0);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), read_file(out_),
          read_file(err_)};
}

Words words(const std::string& text) {
  std::istringstream stream(text);
  return {std::istream_iterator<std::string>(stream), {}};
}

Words joined(Words some, const Words& more) {
  some.insert(some.end(), more.begin(), more.end());
  return some;
}

ProcessResult run_vantage(const Words& arguments, const Words& environment) {
  const TemporaryFolder streams;
  return VantageProcess(arguments, streams.path(), environment).wait();
}

ProcessResult succeeds(ProcessResult result, std::source_location where) {
  if (result.exit_code != 0) {
    ADD_FAILURE_AT(where.file_name(), static_cast<int>(where.line()))
        << "exit code " << result.exit_code << ", expected 0: " << result.err;
  }
  return result;
}

testing::AssertionResult is_one_line(const ProcessResult& result, const std::string& command) {
  const std::string& err = result.err;
  const std::string begin = command.empty() ? "vantage: " : "vantage " + command + ": ";
  if (err.rfind(begin, 0) == 0 && err.find('\n') == err.size() - 1) {
    return testing::AssertionSuccess();
  }
  return testing::AssertionFailure()
         << "stderr is not one line that begins with '" << begin << "': " << err;
}

void expect_failure(const ProcessResult& result, int exit_code, const std::string& says,
                    std::source_location where) {
  const testing::ScopedTrace trace(where.file_name(), static_cast<int>(where.line()), says);
  EXPECT_EQ(result.exit_code, exit_code) << result.err;
  EXPECT_THAT(result.err, HasSubstr(says));
}

void expect_one_line(const ProcessResult& result, int exit_code, const std::string& command,
                     const std::string& says, std::source_location where) {
  const testing::ScopedTrace trace(where.file_name(), static_cast<int>(where.line()), says);
  expect_failure(result, exit_code, says, where);
  EXPECT_TRUE(is_one_line(result, command));
}

std::string read_file(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream content;
  content << file.rdbuf();
  return content.str();
}

nlohmann::json read_json(const fs::path& path) { return nlohmann::json::parse(read_file(path)); }

void write_file(const fs::path& path, const std::string& content) {
  std::ofstream(path, std::ios::binary) << content;
}

Words files_below(const fs::path& folder) {
  Words names;
  if (fs::exists(folder)) {
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
      if (!entry.is_directory()) {
        names.push_back(entry.path().lexically_relative(folder).string());
      }
    }
  }
  std::ranges::sort(names);
  return names;
}

}  // namespace vantage
