#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <span>

#include "engine/io/files/file_descriptor.h"

namespace vantage {

/// Standard output, a pipe or a file, to which a stream goes. Thread rule: one thread at a time.
class StreamOutput {
 public:
  /// What a reader is waited for once a stop is wanted.
  static constexpr std::chrono::milliseconds kPatience{1000};

  /// Writes to `descriptor`, which stays open and as it is. `stop` may be null.
  StreamOutput(int descriptor, const std::atomic<bool>* stop);

  /// Writes all of `bytes`, and waits for the reader. Throws scheduler::Interrupted when `stop` is
  /// raised and the reader takes nothing for kPatience; Error when nobody reads any longer, or the
  /// disk is full.
  void put(std::span<const std::uint8_t> bytes);

 private:
  void await_reader();

  FileDescriptor reopened_;  ///< a pipe opened again, to be written without waiting; or invalid
  int descriptor_;
  bool is_socket_;
  const std::atomic<bool>* stop_;
};

}  // namespace vantage
