#include "scheduler/traced_executor.h"

#include <utility>
#include <vector>

#include "scheduler/processor_account.h"
#include "scheduler/trace.h"

namespace vantage::scheduler {
namespace {

class TracedExecutor final : public Executor {
 public:
  explicit TracedExecutor(std::unique_ptr<Executor> inner) : inner_(std::move(inner)) {}

  [[nodiscard]] std::string_view name() const override { return inner_->name(); }
  [[nodiscard]] int thread_count() const override { return inner_->thread_count(); }

  void parallel_for(int task_count, const std::function<void(int)>& body) override {
    ProcessorAccount* account = ProcessorCharge::account_in_use();
    if (account == nullptr) {
      run_traced(task_count, body);
      return;
    }
    run_traced(task_count, [&](int task) {
      const ProcessorCharge charge(account);
      body(task);
    });
  }

  void run_frame_steps(int in_flight, const FrameSteps& steps) override {
    if (!Trace::is_active()) {
      inner_->run_frame_steps(in_flight, steps);
      return;
    }
    const Span join("frames", SpanKind::kJoin);
    int next_frame = 0;  // only the reading step touches it
    std::vector<int> frame_in(static_cast<std::size_t>(in_flight));
    const auto traced = [&frame_in](std::string_view name, const std::function<void(int)>& step) {
      return [&frame_in, name, &step](int slot) {
        Span::note_pool_thread();
        const Span span(name, SpanKind::kWork, {.frame = frame_in[static_cast<std::size_t>(slot)]});
        step(slot);
      };
    };
    FrameSteps recorded;
    recorded.compute_in_order = steps.compute_in_order;
    recorded.read = [&](int slot) {
      Span::note_pool_thread();
      frame_in[static_cast<std::size_t>(slot)] = next_frame;
      const Span span("read frame", SpanKind::kWork, {.frame = next_frame});
      ++next_frame;
      return steps.read(slot);
    };
    recorded.prepare = traced("prepare frame", steps.prepare);
    recorded.compute = traced("compute frame", steps.compute);
    recorded.encode = traced("encode frame", steps.encode);
    recorded.write = traced("write frame", steps.write);
    inner_->run_frame_steps(in_flight, recorded);
  }

 private:
  void run_traced(int task_count, const std::function<void(int)>& body) {
    if (!Trace::is_active()) {
      inner_->parallel_for(task_count, body);
      return;
    }
    const Span* around = Span::innermost();
    const std::string_view task_name = around == nullptr ? "task" : around->record().name;
    const int frame = around == nullptr ? -1 : around->record().place.frame;
    const Span join("parallel for", SpanKind::kJoin);
    inner_->parallel_for(task_count, [&](int task) {
      Span::note_pool_thread();
      const Span span(task_name, SpanKind::kWork, {.frame = frame, .task = task});
      body(task);
    });
  }

  std::unique_ptr<Executor> inner_;
};

}  // namespace

std::unique_ptr<Executor> with_tracing(std::unique_ptr<Executor> inner) {
  return std::make_unique<TracedExecutor>(std::move(inner));
}

}  // namespace vantage::scheduler
