#include "apps/process/interrupt.h"

#include <array>
#include <csignal>

#include "engine/io/files/unfinished_files.h"

namespace vantage::apps {
namespace {

// A signal handler can reach nothing but statics.
std::atomic<bool> interrupted{false};  // NOLINT(cppcoreguidelines-avoid-non-const-global-variables)
static_assert(std::atomic<bool>::is_always_lock_free);

constexpr std::array kEndingSignals = {SIGINT, SIGTERM, SIGHUP};

/// Such handlers do not interrupt each other.
void handle(int signal, void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  for (const int other : kEndingSignals) {
    sigaddset(&action.sa_mask, other);
  }
  sigaction(signal, &action, nullptr);
}

bool is_ignored(int signal) {
  struct sigaction present {};
  return sigaction(signal, nullptr, &present) == 0 && present.sa_handler == SIG_IGN;
}

extern "C" void end_process(int signal) {
  remove_unfinished_files();
  (void)std::signal(signal, SIG_DFL);
  (void)std::raise(signal);  // taken when this handler returns
}

extern "C" void raise_flag(int signal) {
  interrupted.store(true);
  handle(signal, end_process);
}

}  // namespace

void remove_files_on_signals() {
  for (const int signal : kEndingSignals) {
    if (!is_ignored(signal)) {
      handle(signal, end_process);
    }
  }
}

void request_end() { interrupted.store(true); }

bool is_end_requested() { return interrupted.load(); }

const std::atomic<bool>& interrupt_flag() {
  // Once: a later call must not take back what the first signal has set.
  [[maybe_unused]] static const bool is_handled = [] {
    for (const int signal : kEndingSignals) {
      if (signal != SIGHUP || !is_ignored(signal)) {  // nohup has asked to go on
        handle(signal, raise_flag);
      }
    }
    return true;
  }();
  return interrupted;
}

}  // namespace vantage::apps
