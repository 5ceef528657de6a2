#include "engine/sequence/commit_queue.h"

#include <fmt/format.h>

#include <filesystem>
#include <iterator>
#include <set>
#include <utility>

namespace vantage {
namespace {

/// Few, so that little is lost by a crash; their files hold no memory.
constexpr std::size_t kMaxWaiting = 16;

}  // namespace

CommitQueue::CommitQueue(RunJournal& journal,
                         std::function<void(int frames, double cells)> on_delivered)
    : journal_(journal), on_delivered_(std::move(on_delivered)), thread_([this] { work(); }) {}

CommitQueue::~CommitQueue() {
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void CommitQueue::push(Delivery delivery) {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return waiting_.size() < kMaxWaiting || error_; });
  if (error_) {
    std::rethrow_exception(error_);
  }
  waiting_.push_back(std::move(delivery));
  changed_.notify_all();
}

void CommitQueue::finish() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return (waiting_.empty() && !busy_) || error_; });
  if (error_) {
    std::rethrow_exception(error_);
  }
}

void CommitQueue::work() {
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
    for (const std::filesystem::path& folder : folders) {
      flush_folder(folder);
    }
    if (!records.empty()) {
      try {
        journal_.append(records);
      } catch (const Error& error) {
        throw DeliveryError(fmt::format("frame {}: {}", frame, error.what()));
      }
    }
    if (frames > 0) {
      on_delivered_(frames, cells);
    }
  };
  for (Delivery& delivery : batch) {
    try {
      delivery.files.commit(folders);
    } catch (const OutputError& error) {
      record_delivered();  // what came before the failure counts
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
