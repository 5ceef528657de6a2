#include "scheduler/shared_threads.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <utility>

#include "scheduler/interruption.h"

namespace vantage::scheduler {
namespace {

constexpr std::chrono::milliseconds kInterruptionInterval(20);
/// The share of a call that has ended is kept that long: most callers come back at once, and waking
/// other threads for a moment costs more than it gains.
constexpr std::chrono::milliseconds kReturnTime(5);

// What the call of this thread shares; null without a call, and inside parallel tasks.
// NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables)
thread_local SharedThreads* shared_in_use = nullptr;

}  // namespace

SharedThreads::Call::Call(SharedThreads& threads) : threads_(threads), outer_(shared_in_use) {
  if (outer_ != &threads_) {
    threads_.enter();
    shared_in_use = &threads_;
  }
}

SharedThreads::Call::~Call() {
  if (outer_ != &threads_) {
    shared_in_use = outer_;
    threads_.leave();
  }
}

void SharedThreads::enter() {
  std::unique_lock lock(mutex_);
  const auto waiter = waiting_.emplace(waiting_.end());
  admit();
  try {
    while (!waiter->has_thread) {
      waiter->admitted.wait_for(lock, kInterruptionInterval);
      lock.unlock();
      check_interruption();
      lock.lock();
    }
  } catch (...) {
    lock.lock();
    if (waiter->has_thread) {
      --calls_;
      ++free_;
    }
    waiting_.erase(waiter);
    admit();
    throw;
  }
  waiting_.erase(waiter);
}

void SharedThreads::leave() {
  const std::lock_guard lock(mutex_);
  --calls_;
  ++free_;
  ended_ = std::chrono::steady_clock::now();
  admit();
}

int SharedThreads::take_helpers(int wanted) {
  const std::lock_guard lock(mutex_);
  const bool one_may_return = ended_ && std::chrono::steady_clock::now() - *ended_ < kReturnTime;
  const int calls = calls_ + (one_may_return ? 1 : 0);
  const int share = (thread_count_ + calls - 1) / calls;
  const int helpers = std::min({wanted, share - 1, free_});
  free_ -= helpers;
  return helpers;
}

void SharedThreads::give_back(int threads) {
  const std::lock_guard lock(mutex_);
  free_ += threads;
  admit();
}

void SharedThreads::admit() {
  for (Waiter& waiter : waiting_) {
    if (free_ == 0) {
      return;
    }
    if (!waiter.has_thread) {
      waiter.has_thread = true;
      waiter.admitted.notify_one();
      --free_;
      ++calls_;
      ended_.reset();
    }
  }
}

class SharingExecutor final : public Executor {
 public:
  SharingExecutor(std::unique_ptr<Executor> inner, SharedThreads& threads)
      : inner_(std::move(inner)), threads_(threads) {}

  [[nodiscard]] std::string_view name() const override { return inner_->name(); }
  [[nodiscard]] int thread_count() const override { return inner_->thread_count(); }

  void parallel_for(int task_count, const std::function<void(int)>& body) override {
    if (shared_in_use != &threads_) {
      inner_->parallel_for(task_count, body);
      return;
    }
    const int wanted = std::min(task_count, threads_.thread_count_) - 1;
    const Helpers helpers(threads_, std::max(wanted, 0));
    if (helpers.count() == 0) {
      for (int task = 0; task < task_count; ++task) {
        body(task);
      }
      return;
    }
    // Loops inside tasks have no share: they use what their task's loop has.
    const NoCall no_call;
    if (helpers.count() == wanted) {
      inner_->parallel_for(task_count, body);
    } else {
      run_on(helpers.count() + 1, task_count, body);
    }
  }

  void run_frame_steps(int in_flight, const FrameSteps& steps) override {
    inner_->run_frame_steps(in_flight, steps);
  }

 private:
  class Helpers {
   public:
    Helpers(SharedThreads& threads, int wanted)
        : threads_(threads), count_(threads.take_helpers(wanted)) {}
    Helpers(const Helpers&) = delete;
    Helpers& operator=(const Helpers&) = delete;
    ~Helpers() { threads_.give_back(count_); }
    [[nodiscard]] int count() const { return count_; }

   private:
    SharedThreads& threads_;
    int count_;
  };

  class NoCall {
   public:
    NoCall() : call_(std::exchange(shared_in_use, nullptr)) {}
    NoCall(const NoCall&) = delete;
    NoCall& operator=(const NoCall&) = delete;
    ~NoCall() { shared_in_use = call_; }

   private:
    SharedThreads* call_;
  };

  // One task of `inner` per thread that may work; each takes tasks of the loop while there are any.
  void run_on(int thread_count, int task_count, const std::function<void(int)>& body) {
    std::atomic<int> next = 0;
    inner_->parallel_for(thread_count, [&](int) {
      try {
        for (int task = next++; task < task_count; task = next++) {
          body(task);
        }
      } catch (...) {
        next = task_count;  // as an executor drops tasks that have not started
        throw;
      }
    });
  }

  std::unique_ptr<Executor> inner_;
  SharedThreads& threads_;
};

std::unique_ptr<Executor> sharing(std::unique_ptr<Executor> inner, SharedThreads& threads) {
  return std::make_unique<SharingExecutor>(std::move(inner), threads);
}

}  // namespace vantage::scheduler
