#include "apps/batch/result_keeper.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <chrono>
#include <system_error>
#include <utility>

#include "engine/error.h"

namespace vantage::apps {
namespace {

namespace fs = std::filesystem;

/// What the files below a folder take of the disk.
std::size_t bytes_on_disk(const fs::path& folder) {
  constexpr std::size_t kBlock = 512;  // of st_blocks
  std::size_t bytes = 0;
  std::error_code error;
  for (fs::recursive_directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    struct stat status {};
    if (::lstat(entry->path().c_str(), &status) == 0) {
      bytes += static_cast<std::size_t>(status.st_blocks) * kBlock;
    }
  }
  return bytes;
}

}  // namespace

ResultKeeper::ResultKeeper(ResultMirror& mirror, fs::path folder, double interval_s,
                           std::optional<std::size_t> limit_bytes, const std::atomic<bool>& stop)
    : mirror_(mirror),
      folder_(std::move(folder)),
      interval_s_(interval_s),
      limit_bytes_(limit_bytes),
      stop_(stop),
      thread_([this] { keep_again_and_again(); }) {}

ResultKeeper::~ResultKeeper() {
  ends_ = true;
  if (thread_.joinable()) {
    thread_.join();
  }
}

void ResultKeeper::keep_again_and_again() {
  using Clock = std::chrono::steady_clock;
  constexpr std::chrono::milliseconds kStep{100};
  constexpr int kStepsToLook = 10;
  Clock::time_point last = Clock::now();
  try {
    for (int step = 1; !ends_; ++step) {
      std::this_thread::sleep_for(kStep);
      if (stop_.load()) {
        run_ends_ = true;
        continue;
      }
      const bool looks = limit_bytes_ && step % kStepsToLook == 0;
      const bool is_full = looks && bytes_on_disk(folder_) > *limit_bytes_ / 2;
      if (!is_full && std::chrono::duration<double>(Clock::now() - last).count() < interval_s_) {
        continue;
      }
      mirror_.keep();
      last = Clock::now();
      if (is_full && bytes_on_disk(folder_) > *limit_bytes_) {
        throw Error(fmt::format("its unfinished results need more than `scratch-limit` {} MiB",
                                *limit_bytes_ >> 20));
      }
    }
  } catch (...) {
    problem_ = std::current_exception();
    run_ends_ = true;
  }
}

void ResultKeeper::finish() {
  ends_ = true;
  thread_.join();
  if (problem_) {
    std::rethrow_exception(problem_);
  }
}

}  // namespace vantage::apps
