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
#include "engine/sequence/frame_feed.h"
#include "engine/sequence/frame_flicker.h"
#include "engine/sequence/steps/frame_worker.h"
#include "engine/sequence/steps/step_accounts.h"
#include "scheduler/frame_pipeline.h"
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

}  // namespace

class FrameIterator::Work {
 public:
  Work(const SequenceOptions& options, const SequenceRun& run, const std::vector<int>& frames,
       Execution& execution)
      : run_(run),
        layout_("-", options),
        execution_(execution),
        worker_({options, layout_, run.pairs, run.frame_size, run.rectifier, run.pair_cameras,
                 run.cameras, run.map_camera, run.poses, run.shots, execution, accounts_}),
        feed_(plan_work(selection_of(run, frames), dependence_of(options, layout_),
                        [&](int frame) { return !std::ranges::binary_search(frames, frame); })),
        flicker_(options, execution),
        slots_(static_cast<std::size_t>(run.in_flight)),
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
        compute_some();
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
    changed_.wait(lock, [&] { return is_stopped_ || ahead_ <= run_.in_flight / 2; });
    return !is_stopped_ && !is_read_;
  }

  void compute_some() {
    scheduler::FrameSteps steps;
    const auto within = [this](void (Work::*step)(FrameSlot&)) {
      return [this, step](int slot) {
        scheduler::InterruptibleScope scope([this] { return is_stopped_.load(); });
        (this->*step)(*slots_[static_cast<std::size_t>(slot)]);
      };
    };
    steps.read = [this](int slot) { return read(slots_[static_cast<std::size_t>(slot)]); };
    steps.prepare = within(&Work::prepare);
    steps.compute = within(&Work::compute);
    steps.encode = within(&Work::finish);
    steps.write = [this](int slot) { write(slots_[static_cast<std::size_t>(slot)]); };
    steps.compute_in_order = worker_.computes_in_order();
    const auto skip = [this](int slot, const std::exception_ptr& error) {
      return skip_frame(*slots_[static_cast<std::size_t>(slot)], error);
    };
    scheduler::run_frames(execution_.executor(), run_.in_flight, steps, skip);
  }

  void prepare(FrameSlot& slot) { worker_.prepare(slot); }
  void compute(FrameSlot& slot) { worker_.compute(slot); }
  void finish(FrameSlot& slot) { worker_.finish(slot); }

  bool read(std::unique_ptr<FrameSlot>& slot) {
    {
      const std::scoped_lock lock(mutex_);
      if (is_stopped_ || ahead_ >= run_.in_flight) {
        return false;
      }
    }
    if (!slot) {
      slot = std::make_unique<FrameSlot>();
    }
    slot->times.clear();
    slot->is_absent = false;
    if (!feed_.next(slot->frame, slot->is_lead_in)) {
      const std::scoped_lock lock(mutex_);
      is_read_ = true;
      return false;
    }
    if (!slot->is_lead_in) {
      const std::scoped_lock lock(mutex_);
      ++ahead_;
    }
    if (slot->frame != next_pair_) {
      run_.pairs.skip_to(slot->frame);
    }
    next_pair_ = slot->frame + 1;
    slot->is_absent = !run_.pairs.fetch(slot->pair);
    return true;
  }

  void write(std::unique_ptr<FrameSlot>& slot) {
    if (slot->is_absent) {
      drop(*slot);
      return;
    }
    ComputedFrame frame;
    frame.flicker = flicker_.add(*slot);
    if (slot->is_lead_in) {
      return;
    }
    frame.searched = worker_.searched_in(*slot);
    frame.preview = worker_.preview_range_of_frame(*slot);
    const MatchRequest request = worker_.request();
    frame.has_both_maps = request.left && request.right;
    if (worker_.map_camera_of(*slot) != nullptr) {
      frame.camera = worker_.point_camera(*slot);
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

  bool skip_frame(const FrameSlot& slot, const std::exception_ptr& error) {
    try {
      std::rethrow_exception(error);
    } catch (const UsageError&) {
      throw;
    } catch (const Error& bad) {
      const std::string name = run_.pairs.describe(slot.frame);
      if (!run_.keep_going) {
        throw Error(fmt::format("frame {} ({}): {}", slot.frame, name, bad.what()));
      }
      drop(slot);
      if (!slot.is_lead_in) {
        const std::scoped_lock lock(mutex_);
        skipped_.push_back({slot.frame, fmt::format("{}: {}", name, bad.what())});
      }
      return true;
    }
  }

  const SequenceRun run_;
  const SequenceLayout layout_;
  Execution& execution_;
  StepAccounts accounts_;
  FrameWorker worker_;
  FrameFeed feed_;
  FrameFlicker flicker_;
  std::vector<std::unique_ptr<FrameSlot>> slots_;
  int next_pair_ = -1;  ///< the source may be anywhere at first

  std::mutex stopping_;  ///< held while the thread is joined
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  // Guarded by it.
  std::deque<ComputedFrame> ready_;
  int ahead_ = 0;         ///< frames in work or ready, without those that others depend on
  bool is_read_ = false;  ///< all frames
  bool has_ended_ = false;
  std::exception_ptr problem_;
  std::vector<FrameRemark> skipped_;
  std::atomic<bool> is_stopped_ = false;

  std::thread thread_;  ///< last: it uses all of these
};

FrameIterator::FrameIterator(const SequenceOptions& options, const SequenceRun& run,
                             const std::vector<int>& frames, Execution& execution)
    : work_(std::make_unique<Work>(options, run, frames, execution)) {}

FrameIterator::~FrameIterator() = default;

std::optional<ComputedFrame> FrameIterator::next() { return work_->next(); }

void FrameIterator::stop() { work_->stop(); }

std::vector<FrameRemark> FrameIterator::skipped() const { return work_->skipped(); }

}  // namespace vantage
