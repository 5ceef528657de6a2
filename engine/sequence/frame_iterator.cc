#include "engine/sequence/frame_iterator.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>

#include "engine/error.h"
#include "engine/sequence/frame_flow.h"
#include "engine/sequence/shots/depth_picture.h"
#include "engine/sequence/steps/frame_needs.h"
#include "scheduler/interruption.h"

namespace vantage {
namespace {

/// How often a waiting caller looks whether it is interrupted.
constexpr std::chrono::milliseconds kLookInterval(20);

FrameSelection selection_of(const SequenceRun& run, const std::vector<int>& frames) {
  FrameSelection selection = run.selection;
  selection.shard.reset();
  selection.frames = frames.empty() ? FrameRange{} : FrameRange{frames.front(), frames.back() + 1};
  return selection;
}

std::vector<FrameRun> work_of(const SequenceRun& run, const std::vector<int>& frames,
                              const FrameDependence& dependence) {
  if (run.pairs.is_stream()) {
    return {run_of(run.selection, dependence, run.selection.own())};
  }
  return plan_work(selection_of(run, frames), dependence,
                   [&](int frame) { return !std::ranges::binary_search(frames, frame); });
}

}  // namespace

class FrameIterator::Work final : private FrameFlow {
 public:
  Work(const SequenceOptions& options, const SequenceLayout& layout, const SequenceRun& run,
       const std::vector<int>& frames, Execution& execution)
      : FrameFlow(options, layout, run, work_of(run, frames, dependence_of(options, layout)), false,
                  execution),
        options_(options),
        thread_([this] { compute_all(); }) {}

  Work(const Work&) = delete;
  Work& operator=(const Work&) = delete;
  ~Work() { stop(); }

  void stop() {
    const std::scoped_lock stopping(stopping_);
    if (!thread_.joinable()) {
      return;
    }
    {
      const std::scoped_lock lock(mutex_);
      is_stopped_ = true;
    }
    changed_.notify_all();
    thread_.join();
  }

  std::optional<ComputedFrame> next() {
    std::unique_lock lock(mutex_);
    while (!changed_.wait_for(lock, kLookInterval, [&] { return !ready_.empty() || has_ended_; })) {
      lock.unlock();
      scheduler::check_interruption();
      lock.lock();
    }
    if (is_stopped_) {
      return std::nullopt;
    }
    if (ready_.empty()) {
      if (problem_) {
        std::rethrow_exception(std::exchange(problem_, nullptr));
      }
      return std::nullopt;
    }
    std::optional<ComputedFrame> frame = std::move(ready_.front());
    ready_.pop_front();
    --ahead_;
    lock.unlock();
    tell_delivered(1);
    changed_.notify_all();
    return frame;
  }

  [[nodiscard]] std::vector<FrameRemark> skipped() const {
    const std::scoped_lock lock(mutex_);
    return skipped_;
  }

 private:
  /// The work of the thread: a pipeline that ends when enough frames wait for the caller, and
  /// starts again when half of them are taken. Threads of the execution never wait for the caller,
  /// who may need them.
  void compute_all() {
    try {
      while (may_continue()) {
        (void)flow(nullptr);
      }
    } catch (...) {
      const std::scoped_lock lock(mutex_);
      problem_ = std::current_exception();
    }
    {
      const std::scoped_lock lock(mutex_);
      has_ended_ = true;
    }
    changed_.notify_all();
  }

  bool may_continue() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock,
                  [&] { return is_stopped_ || is_at_end() || ahead_ <= run().in_flight / 2; });
    lock.unlock();
    while (!is_stopped_ && !is_at_end() && !run().pairs.is_ready(kLookInterval)) {
    }
    return !is_stopped_ && !is_at_end();
  }

  bool may_read() override {
    const std::scoped_lock lock(mutex_);
    // Who sends pairs may need the threads of the execution, too.
    return !is_stopped_ && ahead_ < run().in_flight &&
           run().pairs.is_ready(std::chrono::milliseconds(0));
  }

  void begin(FrameSlot& slot) override {
    const std::scoped_lock lock(mutex_);
    ahead_ += slot.is_lead_in ? 0 : 1;
  }

  void take(StepPhase phase, FrameSlot& slot) override {
    scheduler::InterruptibleScope scope([this] { return is_stopped_.load(); });
    FrameFlow::take(phase, slot);
  }

  void write(std::unique_ptr<FrameSlot>& slot) override {
    if (slot->is_absent) {
      drop(*slot);
      return;
    }
    ComputedFrame frame;
    if (slot->is_lead_in) {
      return;
    }
    frame.searched = slot->searched;
    frame.preview =
        preview_range_of_frame(options_, run().shots, slot->frame, slot->pair.details.disparities);
    const MatchRequest request = match_request(options_);
    frame.has_both_maps = request.left && request.right;
    if (cameras().map_camera_of(*slot) != nullptr) {
      frame.camera = cameras().point_camera(*slot);
    }
    frame.slot = std::move(slot);
    {
      const std::scoped_lock lock(mutex_);
      ready_.push_back(std::move(frame));
    }
    changed_.notify_all();
  }

  /// The caller will not get this frame.
  void drop(const FrameSlot& slot) {
    const std::scoped_lock lock(mutex_);
    ahead_ -= slot.is_lead_in ? 0 : 1;
  }

  void skip(FrameSlot& slot, const std::string& name, const std::string& problem) override {
    drop(slot);
    tell_delivered(1);
    const std::scoped_lock lock(mutex_);
    skipped_.push_back({slot.frame, fmt::format("{}: {}", name, problem)});
  }

  const SequenceOptions& options_;

  std::mutex stopping_;  ///< held while the thread is joined
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  // Guarded by it.
  std::deque<ComputedFrame> ready_;
  int ahead_ = 0;  ///< frames in work or ready, without those that others depend on
  bool has_ended_ = false;
  std::exception_ptr problem_;
  std::vector<FrameRemark> skipped_;
  std::atomic<bool> is_stopped_ = false;

  std::thread thread_;  ///< last: it uses all of these
};

FrameIterator::FrameIterator(const SequenceOptions& options, const SequenceRun& run,
                             const std::vector<int>& frames, Execution& execution)
    : work_(std::make_unique<Work>(options, SequenceLayout("-", options), run, frames, execution)) {
}

FrameIterator::~FrameIterator() = default;

std::optional<ComputedFrame> FrameIterator::next() { return work_->next(); }

void FrameIterator::stop() { work_->stop(); }

std::vector<FrameRemark> FrameIterator::skipped() const { return work_->skipped(); }

}  // namespace vantage
