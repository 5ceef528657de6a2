#include "engine/io/files/unfinished_files.h"

#include <pthread.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <set>
#include <string>
#include <thread>

namespace vantage {
namespace {

std::atomic_flag& unfinished_lock() {
  static std::atomic_flag flag;
  return flag;
}

/// Null before the first file: a handler must not take memory. Never destroyed: a signal may come
/// while the process exits.
std::multiset<std::string>*& unfinished() {
  static std::multiset<std::string>* names = nullptr;
  return names;
}

void lock_unfinished() {
  while (unfinished_lock().test_and_set(std::memory_order_acquire)) {
    std::this_thread::yield();
  }
}

/// While it lives, this thread has the files for itself and no handler interrupts it: one that did
/// would wait for its own thread.
class UnfinishedAccess {
 public:
  UnfinishedAccess() {
    sigset_t ending;
    sigemptyset(&ending);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
      sigaddset(&ending, signal);
    }
    pthread_sigmask(SIG_BLOCK, &ending, &before_);
    lock_unfinished();
  }
  UnfinishedAccess(const UnfinishedAccess&) = delete;
  UnfinishedAccess& operator=(const UnfinishedAccess&) = delete;
  ~UnfinishedAccess() {
    unfinished_lock().clear(std::memory_order_release);
    pthread_sigmask(SIG_SETMASK, &before_, nullptr);
  }

 private:
  sigset_t before_{};
};

}  // namespace

void note_unfinished(const std::filesystem::path& file) {
  const UnfinishedAccess access;
  if (unfinished() == nullptr) {
    unfinished() = new std::multiset<std::string>();
  }
  unfinished()->insert(file.string());
}

void forget_unfinished(const std::filesystem::path& file) {
  const UnfinishedAccess access;
  if (unfinished() == nullptr) {
    return;
  }
  const auto known = unfinished()->find(file.string());
  if (known != unfinished()->end()) {
    unfinished()->erase(known);
  }
}

void remove_unfinished_files() noexcept {
  lock_unfinished();
  if (unfinished() == nullptr) {
    return;
  }
  for (const std::string& file : *unfinished()) {
    ::unlink(file.c_str());
  }
}

}  // namespace vantage
