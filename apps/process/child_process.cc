#include "apps/process/child_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <optional>

#include "engine/error.h"
#include "engine/options/setting_value.h"

namespace vantage::apps {
namespace {

constexpr const char* kParent = "VANTAGE_PARENT_PROCESS";

/// Both ends of a pipe; programs started meanwhile do not inherit them.
class Pipe {
 public:
  Pipe() {
    if (::pipe2(ends_.data(), O_CLOEXEC) != 0) {
      throw Error(fmt::format("cannot create a pipe: {}", std::strerror(errno)));
    }
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  ~Pipe() {
    close_end(0);
    close_end(1);
  }

  [[nodiscard]] int read_end() const { return ends_[0]; }
  [[nodiscard]] int write_end() const { return ends_[1]; }
  void close_write_end() { close_end(1); }

 private:
  void close_end(std::size_t end) {
    if (ends_[end] >= 0) {
      ::close(ends_[end]);
      ends_[end] = -1;
    }
  }

  std::array<int, 2> ends_ = {-1, -1};
};

pid_t spawn(const std::vector<std::string>& command, const Pipe& out, const Pipe& err) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, out.write_end(), STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, err.write_end(), STDERR_FILENO);
  // Signals that this process ignores (set_up_process()) are not inherited.
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t usual;
  sigemptyset(&usual);
  sigaddset(&usual, SIGPIPE);
  sigaddset(&usual, SIGXFSZ);
  posix_spawnattr_setsigdefault(&attributes, &usual);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF);
  std::vector<std::string> words = command;  // posix_spawnp wants them writable
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (std::string& word : words) {
    arguments.push_back(word.data());
  }
  arguments.push_back(nullptr);
  pid_t process = 0;
  const int failure =
      ::posix_spawnp(&process, arguments.front(), &actions, &attributes, arguments.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  if (failure != 0) {
    throw Error(fmt::format("{} cannot be started: {}", command.front(), std::strerror(failure)));
  }
  return process;
}

/// Appends the available bytes to `text`; false at the end.
bool read_some(int descriptor, std::string& text) {
  std::array<char, 4096> buffer;
  const ssize_t count = ::read(descriptor, buffer.data(), buffer.size());
  if (count > 0) {
    text.append(buffer.data(), static_cast<std::size_t>(count));
  }
  return count > 0 || (count < 0 && errno == EINTR);
}

/// Asks a program to end once it has to, and later makes it.
class Ending {
 public:
  Ending(pid_t process, const std::atomic<bool>* stop, std::chrono::duration<double> patience)
      : process_(process), stop_(stop), patience_(patience) {}

  /// Whether nothing more is to be done.
  [[nodiscard]] bool is_over() const { return stop_ == nullptr || killed_; }
  void look() {
    const Clock::time_point now = Clock::now();
    if (stop_ != nullptr && !asked_ && stop_->load()) {
      ::kill(process_, SIGTERM);
      asked_ = now;
    }
    if (asked_ && !killed_ && now - *asked_ > patience_) {
      ::kill(process_, SIGKILL);
      killed_ = true;
    }
  }

 private:
  using Clock = std::chrono::steady_clock;
  pid_t process_;
  const std::atomic<bool>* stop_;
  std::chrono::duration<double> patience_;
  std::optional<Clock::time_point> asked_;
  bool killed_ = false;
};

/// Reads both pipes to their ends, as data arrives: a program that fills one waits for its reader.
void read_all(const Pipe& out, const Pipe& err, Ending ending, ProgramResult& result) {
  constexpr int kStopInterval_ms = 100;
  std::array<pollfd, 2> ends = {{{out.read_end(), POLLIN, 0}, {err.read_end(), POLLIN, 0}}};
  const std::array<std::string*, 2> texts = {&result.out, &result.err};
  while (ends[0].fd >= 0 || ends[1].fd >= 0) {
    const int ready = ::poll(ends.data(), ends.size(), ending.is_over() ? -1 : kStopInterval_ms);
    ending.look();
    if (ready < 0) {
      continue;  // interrupted by a signal
    }
    for (std::size_t end = 0; end < ends.size(); ++end) {
      if (ends[end].fd >= 0 && ends[end].revents != 0 && !read_some(ends[end].fd, *texts[end])) {
        ends[end].fd = -1;  // poll() passes over it
      }
    }
  }
}

int wait_for(pid_t process) {
  int status = 0;
  while (::waitpid(process, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
}

}  // namespace

bool program_exists(const std::string& name) {
  const char* path = std::getenv("PATH");
  const std::vector<std::string> folders = split(path == nullptr ? "" : path, ':');
  return std::ranges::any_of(folders, [&](const std::string& folder) {
    const std::filesystem::path file = std::filesystem::path(folder) / name;
    std::error_code ignored;
    return std::filesystem::is_regular_file(file, ignored) && ::access(file.c_str(), X_OK) == 0;
  });
}

ProgramResult run_program(const std::vector<std::string>& command, const std::atomic<bool>* stop,
                          std::chrono::duration<double> patience) {
  Pipe out;
  Pipe err;
  const pid_t process = spawn(command, out, err);
  out.close_write_end();
  err.close_write_end();
  ProgramResult result;
  read_all(out, err, {process, stop, patience}, result);
  result.exit_code = wait_for(process);
  return result;
}

void end_children_with_this() { ::setenv(kParent, fmt::format("{}", ::getpid()).c_str(), 1); }

void end_with_parent() {
  const char* const parent = std::getenv(kParent);
  if (parent == nullptr || fmt::format("{}", ::getppid()) != parent) {
    return;
  }
  ::prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (fmt::format("{}", ::getppid()) != parent) {
    std::raise(SIGTERM);  // it ended before that
  }
}

std::string path_of_this_program() {
  std::error_code error;
  const std::filesystem::path path = std::filesystem::read_symlink("/proc/self/exe", error);
  if (error) {
    throw Error(
        fmt::format("/proc/self/exe: {}, expected the path of this program", error.message()));
  }
  return path.string();
}

std::string shell_word(const std::string& text) {
  const bool plain = !text.empty() && std::ranges::all_of(text, [](unsigned char letter) {
    return std::isalnum(letter) != 0 || std::strchr("/._-+=:,@%", letter) != nullptr;
  });
  if (plain) {
    return text;
  }
  std::string word = "'";
  for (const char letter : text) {
    word += letter == '\'' ? std::string("'\\''") : std::string(1, letter);
  }
  return word + "'";
}

}  // namespace vantage::apps
