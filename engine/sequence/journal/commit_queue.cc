#include "engine/sequence/journal/commit_queue.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <iterator>
#include <set>
#include <utility>

#include "engine/io/files/file_descriptor.h"
#include "scheduler/trace.h"

namespace vantage {
namespace {

/// Few, so that a crash loses little; their files hold no memory.
constexpr std::size_t kMaxWaiting = 16;

/// Threads that flush concurrently: a disk flushes several files in little more than the time of
/// one, and four achieve most of the gain.
constexpr std::size_t kFlushThreads = 4;

/// Calls flush(i) for i in [0, count), several at a time, then rethrows the error of the first that
/// failed.
template <typename Flush>
void flush_together(std::size_t count, const Flush& flush) {
  std::atomic<std::size_t> next{0};
  std::vector<std::exception_ptr> errors(count);
  scheduler::ProcessorAccount* account = scheduler::ProcessorCharge::account_in_use();
  const auto take_turns = [&] {
    const scheduler::ProcessorCharge charge(account);
    for (std::size_t i = next++; i < count; i = next++) {
      try {
        flush(i);
      } catch (...) {
        errors[i] = std::current_exception();
      }
    }
  };
  {
    std::vector<std::jthread> others;
    for (std::size_t thread = 1; thread < std::min(count, kFlushThreads); ++thread) {
      others.emplace_back(take_turns);
    }
    take_turns();
  }
  for (const std::exception_ptr& error : errors) {
    if (error) {
      std::rethrow_exception(error);
    }
  }
}

/// Names the videos durably, because the next journal records refer to them.
void finish_videos(const std::vector<std::shared_ptr<VideoWriter>>& videos) {
  flush_together(videos.size(), [&](std::size_t i) { videos[i]->finish(); });
}

}  // namespace

CommitQueue::CommitQueue(RunJournal& journal,
                         std::function<void(int frames, double cells)> on_delivered,
                         scheduler::ProcessorAccount* account)
    : journal_(journal),
      on_delivered_(std::move(on_delivered)),
      account_(account),
      thread_([this] { work(); }) {}

CommitQueue::~CommitQueue() {
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void CommitQueue::push(Delivery delivery) {
  const scheduler::Span wait("disk", scheduler::SpanKind::kWait);
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return waiting_.size() < kMaxWaiting || error_; });
  if (error_) {
    std::rethrow_exception(error_);
  }
  waiting_.push_back(std::move(delivery));
  changed_.notify_all();
}

void CommitQueue::finish() {
  const scheduler::Span wait("disk", scheduler::SpanKind::kWait);
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return (waiting_.empty() && !busy_) || error_; });
  if (error_) {
    std::rethrow_exception(error_);
  }
}

void CommitQueue::work() {
  scheduler::name_traced_thread("deliveries");
  const scheduler::ProcessorCharge charge(account_);
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [&] { return !waiting_.empty() || closed_; });
    if (waiting_.empty() || error_) {
      return;
    }
    std::vector<Delivery> batch(std::make_move_iterator(waiting_.begin()),
                                std::make_move_iterator(waiting_.end()));
    waiting_.clear();
    busy_ = true;
    lock.unlock();
    changed_.notify_all();
    std::exception_ptr error;
    try {
      const scheduler::Span span("deliver");
      deliver(batch);
    } catch (...) {
      error = std::current_exception();
    }
    batch.clear();
    lock.lock();
    busy_ = false;
    error_ = error;
    changed_.notify_all();
    if (error_) {
      return;
    }
  }
}

void CommitQueue::deliver(std::vector<Delivery>& batch) {
  std::set<std::filesystem::path> folders;
  std::vector<JournalRecord> records;
  int frame = 0;
  int frames = 0;
  double cells = 0;
  const auto record_delivered = [&] {
    const std::vector<std::filesystem::path> changed(folders.begin(), folders.end());
    try {
      flush_together(changed.size(), [&](std::size_t i) { flush_folder(changed[i]); });
      if (!records.empty()) {
        journal_.append(records);
      }
    } catch (const Error& error) {
      throw DeliveryError(fmt::format("frame {}: {}", frame, error.what()));
    }
    if (frames > 0) {
      on_delivered_(frames, cells);
    }
  };
  std::vector<std::pair<PendingFiles*, std::size_t>> files;
  for (Delivery& delivery : batch) {
    for (std::size_t index = 0; index < delivery.files.count(); ++index) {
      files.emplace_back(&delivery.files, index);
    }
  }
  flush_together(files.size(), [&](std::size_t i) { files[i].first->flush(files[i].second); });
  for (Delivery& delivery : batch) {
    try {
      delivery.files.commit(folders);
      finish_videos(delivery.videos);
      if (delivery.segment) {
        for (FileRecord& file : delivery.segment->files) {
          file = record_of_file(delivery.folder, file.name);
        }
        delivery.records.emplace_back(*std::move(delivery.segment));
      }
    } catch (const Error& error) {
      record_delivered();  // deliveries before the failure count
      throw DeliveryError(fmt::format("frame {}: {}", delivery.frame, error.what()));
    }
    std::ranges::move(delivery.records, std::back_inserter(records));
    frame = delivery.frame;
    frames += delivery.frames;
    cells += delivery.cells;
  }
  record_delivered();
}

}  // namespace vantage
