#pragma once

#include <condition_variable>
#include <deque>
#include <exception>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "engine/io/video_io.h"
#include "engine/sequence/pending_files.h"
#include "engine/sequence/run_journal.h"

namespace vantage {

/// A delivery failed; says which frame it was of.
class DeliveryError : public OutputError {
 public:
  using OutputError::OutputError;
};

/// Results that are to become visible together, and what the journal is to say then.
struct Delivery {
  PendingFiles files;
  std::vector<std::unique_ptr<VideoWriter>> videos;  ///< that have all their frames
  std::vector<JournalRecord> records;
  /// Of `videos`, which lie below `folder`; what is in them is known once they are finished.
  std::optional<SegmentRecord> segment = {};
  std::filesystem::path folder = {};
  int frame = 0;     ///< the newest one it is about, for messages
  int frames = 0;    ///< so many frames are finished by it, and
  double cells = 0;  ///< so many cells were computed for them: for progress
};

/// Makes deliveries safe, one after the other, on a thread of its own, so that no thread of the
/// pool waits for the disk unless that is slower for long: files are flushed, several at a time,
/// and named, videos finished, folders flushed, then the journal written and flushed. Deliveries
/// that have piled up meanwhile are worked off together.
///
/// Thread rule: push() from one thread at a time; `on_delivered` is called on the queue's thread.
class CommitQueue {
 public:
  /// `journal` must outlive the queue.
  CommitQueue(RunJournal& journal, std::function<void(int frames, double cells)> on_delivered);
  CommitQueue(const CommitQueue&) = delete;
  CommitQueue& operator=(const CommitQueue&) = delete;
  /// Finishes what has been pushed.
  ~CommitQueue();

  /// Waits while many deliveries are ahead. Throws the DeliveryError of an earlier one;
  /// nothing behind a failed one is delivered.
  void push(Delivery delivery);
  /// Waits for all. Throws the DeliveryError of one of them.
  void finish();

 private:
  void work();
  void deliver(std::vector<Delivery>& batch);

  RunJournal& journal_;
  std::function<void(int frames, double cells)> on_delivered_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Delivery> waiting_;
  bool busy_ = false;
  bool closed_ = false;
  std::exception_ptr error_;
  std::thread thread_;  // last: runs while all others are there
};

}  // namespace vantage
