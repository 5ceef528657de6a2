#pragma once

#include <atomic>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <optional>
#include <thread>

#include "apps/batch/result_mirror.h"

namespace vantage::apps {

/// While a run works in a folder, keeps its results in a store: each `interval_s`, and before the
/// folder takes more than half of its limit. Thread rule: one thread at a time.
class ResultKeeper {
 public:
  /// All must outlive it. `stop` is the batch's.
  ResultKeeper(ResultMirror& mirror, std::filesystem::path folder, double interval_s,
               std::optional<std::size_t> limit_bytes, const std::atomic<bool>& stop);
  ResultKeeper(const ResultKeeper&) = delete;
  ResultKeeper& operator=(const ResultKeeper&) = delete;
  ~ResultKeeper();

  /// Whether the run has to end: the batch is stopped, or nothing can be kept.
  [[nodiscard]] const std::atomic<bool>& run_ends() const { return run_ends_; }
  /// Ends the keeping. Throws what ended it, Error.
  void finish();

 private:
  void keep_again_and_again();

  ResultMirror& mirror_;
  std::filesystem::path folder_;
  double interval_s_;
  std::optional<std::size_t> limit_bytes_;
  const std::atomic<bool>& stop_;
  std::atomic<bool> run_ends_ = false;
  std::atomic<bool> ends_ = false;
  std::exception_ptr problem_;
  std::thread thread_;  ///< last: it uses the others
};

}  // namespace vantage::apps
