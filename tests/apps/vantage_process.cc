#include "tests/apps/vantage_process.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "tests/temporary_folder.h"
#include "tests/test_paths.h"

namespace vantage {
namespace {

/// As exec wants them; ends with null.
std::vector<char*> pointers(std::vector<std::string>& texts) {
  std::vector<char*> all;
  for (std::string& text : texts) {
    all.push_back(text.data());
  }
  all.push_back(nullptr);
  return all;
}

std::string name_of(const std::string& variable) { return variable.substr(0, variable.find('=')); }

std::vector<std::string> with_changes(char** variables, const std::vector<std::string>& changes) {
  std::vector<std::string> all = changes;
  for (; *variables != nullptr; ++variables) {
    const std::string name = name_of(*variables);
    if (std::ranges::none_of(changes, [&](const auto& other) { return name_of(other) == name; })) {
      all.emplace_back(*variables);
    }
  }
  return all;
}

}  // namespace

VantageProcess::VantageProcess(const std::vector<std::string>& arguments,
                               const std::filesystem::path& folder,
                               const std::vector<std::string>& environment)
    : out_(folder / "stdout"), err_(folder / "stderr") {
  const std::string binary = test_paths::vantage_binary();
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  constexpr int kFlags = O_CREAT | O_TRUNC | O_WRONLY;
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, out_.c_str(), kFlags, 0600);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, err_.c_str(), kFlags, 0600);
  std::vector<std::string> texts = {binary};
  texts.insert(texts.end(), arguments.begin(), arguments.end());
  std::vector<std::string> changes = environment;
  if (std::ranges::none_of(changes, [](const std::string& variable) {
        return name_of(variable) == "XDG_CONFIG_HOME";
      })) {
    // What whoever runs the tests has tuned is not to be found.
    changes.push_back("XDG_CONFIG_HOME=" + (std::filesystem::absolute(folder) / "config").string());
  }
  std::vector<std::string> variables = with_changes(environ, changes);
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

ProcessResult run_vantage(const std::vector<std::string>& arguments,
                          const std::vector<std::string>& environment) {
  const TemporaryFolder streams;
  return VantageProcess(arguments, streams.path(), environment).wait();
}

std::string read_file(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream content;
  content << file.rdbuf();
  return content.str();
}

void write_file(const std::filesystem::path& path, const std::string& content) {
  std::ofstream(path, std::ios::binary) << content;
}

std::vector<std::string> files_below(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  if (std::filesystem::exists(folder)) {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
      if (!entry.is_directory()) {
        names.push_back(entry.path().lexically_relative(folder).string());
      }
    }
  }
  std::ranges::sort(names);
  return names;
}

}  // namespace vantage
