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

#include "engine/io/video/video_io.h"
#include "engine/sequence/journal/pending_files.h"
#include "engine/sequence/journal/run_journal.h"
#include "scheduler/processor_account.h"

namespace vantage {

/// What is ready cannot be delivered; the message says all.
class DeliveryError : public OutputError {
 public:
  using OutputError::OutputError;
};

/// Results that become visible together, and their journal records.
struct Delivery {
  PendingFiles files;
  std::vector<std::shared_ptr<VideoWriter>> videos;  ///< with all their frames
  std::vector<JournalRecord> records;
  /// Record of `videos`, which lie below `folder`; their content is known once they are finished.
  std::optional<SegmentRecord> segment = {};
  std::filesystem::path folder = {};
  int frame = 0;     ///< newest frame of the delivery, for messages
  int frames = 0;    ///< progress: number of frames that it finishes
  double cells = 0;  ///< progress: number of cells computed for them
};

/// Makes deliveries durable, one after the other, on its own thread, so that no pool thread waits
/// for the disk unless the disk stays slower for long: flushes the files, several at a time, and
/// names them, finishes videos, flushes the folders, then writes and flushes the journal.
/// Deliveries that have accumulated meanwhile are processed together.
///
/// Thread rule: push() from one thread at a time; `on_delivered` is called on the queue's thread.
class CommitQueue {
 public:
  /// `journal` and `account`, which is charged for the work unless it is null, must outlive the
  /// queue.
  CommitQueue(RunJournal& journal, std::function<void(int frames, double cells)> on_delivered,
              scheduler::ProcessorAccount* account = nullptr);
  CommitQueue(const CommitQueue&) = delete;
  CommitQueue& operator=(const CommitQueue&) = delete;
  /// Finishes the pushed deliveries.
  ~CommitQueue();

  /// Blocks while many deliveries are queued. Throws the DeliveryError of an earlier one; nothing
  /// after a failed one is delivered.
  void push(Delivery delivery);
  /// Waits for all. Throws the DeliveryError of one of them.
  void finish();

 private:
  void work();
  void deliver(std::vector<Delivery>& batch);

  RunJournal& journal_;
  std::function<void(int frames, double cells)> on_delivered_;
  scheduler::ProcessorAccount* account_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Delivery> waiting_;
  bool busy_ = false;
  bool closed_ = false;
  std::exception_ptr error_;
  std::thread thread_;  // last: uses all other members
};

}  // namespace vantage
