#include "scheduler/thread_sanitizer.h"

#include <sanitizer/tsan_interface.h>

#include <utility>
#include <vector>

namespace vantage::scheduler {
namespace {

/// A point in time: what happened before declare_reached() is visible after await().
class Moment {
 public:
  void declare_reached() { __tsan_release(&address_); }
  void await() { __tsan_acquire(&address_); }

 private:
  char address_ = 0;
};

/// Declares a moment reached when a scope ends, by an exception or not.
class ReachedAtEnd {
 public:
  explicit ReachedAtEnd(Moment& moment) : moment_(moment) {}
  ReachedAtEnd(const ReachedAtEnd&) = delete;
  ReachedAtEnd& operator=(const ReachedAtEnd&) = delete;
  ~ReachedAtEnd() { moment_.declare_reached(); }

 private:
  Moment& moment_;
};

class ExecutorWithDeclaredOrder final : public Executor {
 public:
  explicit ExecutorWithDeclaredOrder(std::unique_ptr<Executor> inner) : inner_(std::move(inner)) {}

  [[nodiscard]] std::string_view name() const override { return inner_->name(); }
  [[nodiscard]] int thread_count() const override { return inner_->thread_count(); }

  void parallel_for(int task_count, const std::function<void(int)>& body) override {
    Moment begun;
    Moment task_done;
    begun.declare_reached();
    const auto ordered = [&](int task) {
      begun.await();
      const ReachedAtEnd done(task_done);
      body(task);
    };
    try {
      inner_->parallel_for(task_count, ordered);
    } catch (...) {
      task_done.await();
      throw;
    }
    task_done.await();
  }

  void run_frame_steps(int in_flight, const FrameSteps& steps) override {
    std::vector<Moment> slot_done(static_cast<std::size_t>(in_flight));
    Moment begun;
    Moment reading_done;
    Moment computing_done;
    Moment writing_done;
    begun.declare_reached();
    const auto enter = [&](int slot, Moment& previous) -> Moment& {
      Moment& own = slot_done[static_cast<std::size_t>(slot)];
      begun.await();
      own.await();
      previous.await();
      return own;
    };
    FrameSteps ordered;
    ordered.read = [&](int slot) {
      const ReachedAtEnd slot_end(enter(slot, reading_done));
      const ReachedAtEnd reading_end(reading_done);
      return steps.read(slot);
    };
    ordered.prepare = [&](int slot) {
      const ReachedAtEnd slot_end(enter(slot, begun));
      steps.prepare(slot);
    };
    ordered.compute_in_order = steps.compute_in_order;
    ordered.compute = [&](int slot) {
      const ReachedAtEnd slot_end(enter(slot, steps.compute_in_order ? computing_done : begun));
      if (!steps.compute_in_order) {
        steps.compute(slot);
        return;
      }
      const ReachedAtEnd computing_end(computing_done);
      steps.compute(slot);
    };
    ordered.encode = [&](int slot) {
      const ReachedAtEnd slot_end(enter(slot, begun));
      steps.encode(slot);
    };
    ordered.write = [&](int slot) {
      const ReachedAtEnd slot_end(enter(slot, writing_done));
      const ReachedAtEnd writing_end(writing_done);
      steps.write(slot);
    };
    inner_->run_frame_steps(in_flight, ordered);
    reading_done.await();
    writing_done.await();
  }

 private:
  std::unique_ptr<Executor> inner_;
};

}  // namespace

std::unique_ptr<Executor> with_declared_order(std::unique_ptr<Executor> inner) {
  return std::make_unique<ExecutorWithDeclaredOrder>(std::move(inner));
}

}  // namespace vantage::scheduler
