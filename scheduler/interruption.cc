#include "scheduler/interruption.h"

#include <utility>

namespace vantage::scheduler {
namespace {

constexpr std::chrono::milliseconds kCallInterval(20);

// NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables)
thread_local InterruptibleScope* scope_in_use = nullptr;

class InterruptibleExecutor final : public Executor {
 public:
  explicit InterruptibleExecutor(std::unique_ptr<Executor> inner) : inner_(std::move(inner)) {}

  [[nodiscard]] std::string_view name() const override { return inner_->name(); }
  [[nodiscard]] int thread_count() const override { return inner_->thread_count(); }

  void parallel_for(int task_count, const std::function<void(int)>& body) override {
    InterruptibleScope* const scope = InterruptibleScope::in_use();
    if (scope == nullptr) {
      inner_->parallel_for(task_count, [&](int task) {
        // A waiting thread may run tasks of another thread's loop, which its scope must not end.
        const InterruptibleScope::Use use(nullptr);
        body(task);
      });
      return;
    }
    inner_->parallel_for(task_count, [&](int task) {
      const InterruptibleScope::Use use(scope);
      scope->check();
      body(task);
    });
  }

  void run_frame_steps(int in_flight, const FrameSteps& steps) override {
    inner_->run_frame_steps(in_flight, steps);
  }

 private:
  std::unique_ptr<Executor> inner_;
};

}  // namespace

InterruptibleScope::Use::Use(InterruptibleScope* scope)
    : before_(std::exchange(scope_in_use, scope)) {}
InterruptibleScope::Use::~Use() { scope_in_use = before_; }

InterruptibleScope::InterruptibleScope(std::function<bool()> is_wanted)
    : is_wanted_(std::move(is_wanted)),
      next_call_(std::chrono::steady_clock::now() + kCallInterval),
      use_(this) {}
InterruptibleScope::~InterruptibleScope() = default;

InterruptibleScope* InterruptibleScope::in_use() { return scope_in_use; }

void InterruptibleScope::check() {
  if (std::this_thread::get_id() == thread_ && !interrupted_.load(std::memory_order_relaxed)) {
    const auto now = std::chrono::steady_clock::now();
    if (now >= next_call_) {
      interrupted_.store(is_wanted_(), std::memory_order_relaxed);
      next_call_ = now + kCallInterval;
    }
  }
  if (interrupted_.load(std::memory_order_relaxed)) {
    throw Interrupted();
  }
}

void check_interruption() {
  if (InterruptibleScope* const scope = InterruptibleScope::in_use()) {
    scope->check();
  }
}

std::unique_ptr<Executor> interruptible(std::unique_ptr<Executor> inner) {
  return std::make_unique<InterruptibleExecutor>(std::move(inner));
}

}  // namespace vantage::scheduler
