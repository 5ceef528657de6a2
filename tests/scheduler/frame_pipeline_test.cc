#include "scheduler/frame_pipeline.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <span>
#include <stdexcept>
#include <string_view>
#include <thread>

#include "tests/scheduler/executor_cases.h"
#include "tests/test_sample.h"

namespace vantage::scheduler::frame_pipeline_test {

enum class Step { kRead, kPrepare, kCompute, kEncode, kWrite };
constexpr Step kSteps[] = {Step::kRead, Step::kPrepare, Step::kCompute, Step::kEncode,
                           Step::kWrite};

std::string message(int frame, Step step) {
  constexpr std::string_view names[] = {"read", "prepare", "compute", "encode", "write"};
  return "frame " + std::to_string(frame) + " " +
         std::string(names[static_cast<std::size_t>(step)]);
}

struct Failure {
  int frame;
  Step step;
};

/// A sequence of frames that watches how it is run.
class Sequence {
 public:
  Sequence(Executor& executor, int frames, int in_flight, std::vector<Failure> failures = {})
      : executor_(executor),
        frames_(frames),
        in_flight_(in_flight),
        failures_(std::move(failures)),
        slot_frame_(static_cast<std::size_t>(in_flight), kFree) {}

  FrameOutcome run(const std::atomic<bool>* stop = nullptr) {
    FrameSteps steps;
    steps.read = [this](int slot) { return read(slot); };
    steps.compute = [this](int slot) { compute(slot); };
    steps.prepare = [this](int slot) { work_on(slot, Step::kPrepare); };
    steps.encode = [this](int slot) { work_on(slot, Step::kEncode); };
    steps.write = [this](int slot) { write(slot); };
    steps.compute_in_order = compute_in_order;
    return run_frames(executor_, in_flight_, steps, skip, stop);
  }

  /// The frames that were written, in the order of writing.
  [[nodiscard]] const std::vector<int>& written() const { return written_; }
  [[nodiscard]] int frames_read() const { return next_frame_; }
  [[nodiscard]] int frames_computed() const { return computed_; }
  /// The frames that were computed, in that order; kept for compute_in_order only.
  [[nodiscard]] const std::vector<int>& order_computed() const { return order_computed_; }
  [[nodiscard]] const std::vector<int>& skipped() const { return skipped_; }
  bool compute_in_order = false;
  SkipFrame skip;
  /// Skips every frame that fails but for `last`, which ends the run.
  void skip_all_but(int last) {
    skip = [this, last](int slot, const std::exception_ptr& error) {
      const Alone alone(writing_);
      EXPECT_TRUE(error);
      const int frame = frame_in(slot);
      skipped_.push_back(frame);
      --under_way_;
      frame_in(slot) = kFree;
      return frame != last;
    };
  }
  /// Called with the number of a frame just written.
  std::function<void(int)> after_write = [](int) {};

 private:
  static constexpr int kFree = -1;
  static constexpr int kNestedTasks = 5;

  bool read(int slot) {
    const Alone alone(reading_);
    EXPECT_GE(slot, 0);
    EXPECT_LT(slot, in_flight_);
    if (next_frame_ == frames_) {
      return false;
    }
    const int frame = next_frame_++;
    EXPECT_EQ(frame_in(slot), kFree) << "slot " << slot << " is in use";
    frame_in(slot) = frame;
    EXPECT_LE(++under_way_, in_flight_);
    fail_if_due(frame, Step::kRead);
    nested_loop();
    return true;
  }
  void compute(int slot) {
    const int frame = frame_in(slot);
    if (compute_in_order) {
      const Alone alone(computing_);
      order_computed_.push_back(frame);
    }
    // Frames overtake each other: the first of each three takes longest.
    std::this_thread::sleep_for(std::chrono::microseconds(frame % 3 == 0 ? 300 : 0));
    fail_if_due(frame, Step::kCompute);
    nested_loop();
    EXPECT_EQ(frame_in(slot), frame);
    ++computed_;
  }
  void work_on(int slot, Step step) {
    const int frame = frame_in(slot);
    fail_if_due(frame, step);
    nested_loop();
    EXPECT_EQ(frame_in(slot), frame);
  }
  void write(int slot) {
    const Alone alone(writing_);
    const int frame = frame_in(slot);
    fail_if_due(frame, Step::kWrite);
    nested_loop();
    written_.push_back(frame);
    --under_way_;
    frame_in(slot) = kFree;
    after_write(frame);
  }

  /// Finds two threads in a step that is for one at a time.
  class Alone {
   public:
    explicit Alone(std::atomic<int>& inside) : inside_(inside) { EXPECT_EQ(++inside_, 1); }
    Alone(const Alone&) = delete;
    Alone& operator=(const Alone&) = delete;
    ~Alone() { --inside_; }

   private:
    std::atomic<int>& inside_;
  };

  int& frame_in(int slot) { return slot_frame_.at(slot); }

  void nested_loop() {
    std::array<std::atomic<int>, kNestedTasks> calls{};
    executor_.parallel_for(kNestedTasks, [&](int task) { ++calls.at(task); });
    for (const std::atomic<int>& count : calls) {
      EXPECT_EQ(count, 1);
    }
  }
  void fail_if_due(int frame, Step step) const {
    for (const Failure& failure : failures_) {
      if (failure.frame == frame && failure.step == step) {
        throw std::runtime_error(message(frame, step));
      }
    }
  }

  Executor& executor_;
  int frames_;
  int in_flight_;
  std::vector<Failure> failures_;
  int next_frame_ = 0;
  std::vector<int> slot_frame_;
  std::vector<int> written_;
  std::vector<int> skipped_;
  std::vector<int> order_computed_;
  std::atomic<int> computed_{0};
  std::atomic<int> computing_{0};
  std::atomic<int> under_way_{0};
  std::atomic<int> reading_{0};
  std::atomic<int> writing_{0};
};

std::vector<int> first_frames(int count) {
  std::vector<int> frames;
  for (int frame = 0; frame < count; ++frame) {
    frames.push_back(frame);
  }
  return frames;
}

constexpr int kInFlight[] = {1, 2, 5};

/// Failures of two frames: executor; both steps; distance of the frames; in flight.
const std::vector<vantage::test::SampleRow>& failure_rows() {
  static const auto rows = vantage::test::sampled_rows(
      {static_cast<int>(executor_cases().size()), 25, 4, static_cast<int>(std::size(kInFlight))});
  return rows;
}

class FramePipeline : public testing::TestWithParam<int> {
 protected:
  [[nodiscard]] Executor& executor() { return *executor_; }

  /// The frame that fails first in the order of frames must be the one that ends the run.
  void expect_first_failure(int frames, const std::vector<Failure>& failures,
                            std::span<const int> all_in_flight = kInFlight) {
    const Failure first =
        *std::min_element(failures.begin(), failures.end(), [](const Failure& a, const Failure& b) {
          return std::pair(a.frame, a.step) < std::pair(b.frame, b.step);
        });
    for (const int in_flight : all_in_flight) {
      Sequence sequence(executor(), frames, in_flight, failures);
      try {
        sequence.run();
        FAIL() << "nothing was thrown, expected " << message(first.frame, first.step);
      } catch (const std::runtime_error& error) {
        EXPECT_EQ(error.what(), message(first.frame, first.step)) << in_flight << " in flight";
      }
      EXPECT_EQ(sequence.written(), first_frames(first.frame)) << in_flight << " in flight";
      // Reading ends soon: nothing is read once the failure has been delivered.
      EXPECT_LE(sequence.frames_read(), first.frame + in_flight + 1);
    }
  }

 private:
  std::unique_ptr<Executor> executor_ = executor_cases()[GetParam()].make();
};
INSTANTIATE_TEST_SUITE_P(Kinds, FramePipeline,
                         testing::Range(0, static_cast<int>(executor_cases().size())),
                         [](const auto& test) {
                           return executor_test_name({executor_cases()[test.param], 0});
                         });

TEST_P(FramePipeline, WritesAllFramesInOrder) {
  for (const int in_flight : kInFlight) {
    for (const int frames : {0, 1, 2, 23}) {
      Sequence sequence(executor(), frames, in_flight);
      const FrameOutcome outcome = sequence.run();
      EXPECT_EQ(outcome.frames_written, frames);
      EXPECT_FALSE(outcome.interrupted);
      EXPECT_EQ(sequence.written(), first_frames(frames)) << in_flight << " in flight";
      EXPECT_EQ(sequence.frames_computed(), frames);
    }
  }
}

TEST_P(FramePipeline, AnyFailingStepEndsTheRunAtItsFrame) {
  SCOPED_TRACE(vantage::test::sample_name());
  constexpr int kFrames[] = {0, 1, 4, 11};
  static const auto rows =
      vantage::test::sampled_rows({static_cast<int>(executor_cases().size()), 5, 4, 3});
  for (const auto& row : vantage::test::rows_of(rows, GetParam())) {
    expect_first_failure(12, {{kFrames[row[2]], kSteps[row[1]]}}, {&kInFlight[row[3]], 1});
  }
}

TEST_P(FramePipeline, FirstFailingFrameWinsWhateverStepsFail) {
  SCOPED_TRACE(vantage::test::sample_name());
  for (const auto& row : vantage::test::rows_of(failure_rows(), GetParam())) {
    const Step first = kSteps[row[1] / 5];
    const Step second = kSteps[row[1] % 5];
    const std::span<const int> in_flight(&kInFlight[row[3]], 1);
    if (row[2] == 3) {
      // A frame that is computed for long fails behind one that fails at once.
      expect_first_failure(12, {{0, Step::kCompute}, {1, first}, {2, second}}, in_flight);
    } else {
      const int distance = 1 << row[2];
      expect_first_failure(12, {{3 + distance, second}, {3, first}}, in_flight);
    }
  }
}

TEST_P(FramePipeline, SkippedFramesLeaveTheOthersWhole) {
  const std::vector<Failure> failures = {{0, Step::kWrite}, {2, Step::kRead},
                                         {3, Step::kRead},  {5, Step::kCompute},
                                         {6, Step::kWrite}, {9, Step::kEncode}};
  for (const int in_flight : kInFlight) {
    Sequence all(executor(), 12, in_flight, failures);
    all.skip_all_but(-1);
    const FrameOutcome outcome = all.run();
    EXPECT_EQ(outcome.frames_written, 6);
    EXPECT_EQ(all.written(), (std::vector<int>{1, 4, 7, 8, 10, 11}));
    EXPECT_EQ(all.skipped(), (std::vector<int>{0, 2, 3, 5, 6, 9}));

    Sequence until(executor(), 12, in_flight, failures);
    until.skip_all_but(5);
    EXPECT_THROW(until.run(), std::runtime_error);
    EXPECT_EQ(until.written(), (std::vector<int>{1, 4}));
    EXPECT_EQ(until.skipped(), (std::vector<int>{0, 2, 3, 5}));
  }
}

TEST_P(FramePipeline, AnErrorOfSkippingEndsTheRun) {
  Sequence sequence(executor(), 8, 3, {{2, Step::kCompute}});
  sequence.skip = [](int, const std::exception_ptr&) -> bool { throw std::logic_error("full"); };
  EXPECT_THROW(sequence.run(), std::logic_error);
  EXPECT_EQ(sequence.written(), first_frames(2));
}

TEST_P(FramePipeline, ComputesInOrderWhereAsked) {
  for (const int in_flight : kInFlight) {
    Sequence sequence(executor(), 23, in_flight);
    sequence.compute_in_order = true;
    EXPECT_EQ(sequence.run().frames_written, 23);
    EXPECT_EQ(sequence.order_computed(), first_frames(23));
    EXPECT_EQ(sequence.written(), first_frames(23));
  }
}

TEST_P(FramePipeline, FailureOfTheOnlyFrame) {
  for (const Step step : kSteps) {
    expect_first_failure(1, {{0, step}});
  }
}

TEST_P(FramePipeline, RunsAgainAfterAFailure) {
  for (int round = 0; round < 3; ++round) {
    expect_first_failure(6, {{2, Step::kCompute}});
    Sequence sequence(executor(), 6, 2);
    EXPECT_EQ(sequence.run().frames_written, 6);
  }
}

TEST_P(FramePipeline, StopWritesWhatIsUnderWayAndReadsNoMore) {
  for (const int in_flight : kInFlight) {
    for (const int last : {0, 3}) {
      std::atomic<bool> stop{false};
      Sequence sequence(executor(), 100, in_flight);
      sequence.after_write = [&](int frame) {
        if (frame == last) {
          stop = true;
        }
      };
      const FrameOutcome outcome = sequence.run(&stop);
      EXPECT_TRUE(outcome.interrupted);
      EXPECT_EQ(outcome.frames_written, sequence.frames_read());
      EXPECT_EQ(sequence.written(), first_frames(sequence.frames_read()));
      EXPECT_GT(sequence.frames_read(), last);
      // Those under way at that moment, and one that was just being read.
      EXPECT_LE(sequence.frames_read(), last + 1 + in_flight);
    }
  }
}

TEST_P(FramePipeline, StopBeforeTheStartReadsNothing) {
  const std::atomic<bool> stop{true};
  Sequence sequence(executor(), 5, 2);
  const FrameOutcome outcome = sequence.run(&stop);
  EXPECT_TRUE(outcome.interrupted);
  EXPECT_EQ(outcome.frames_written, 0);
  EXPECT_EQ(sequence.frames_read(), 0);
}

TEST_P(FramePipeline, StopThatIsNotRaisedChangesNothing) {
  const std::atomic<bool> stop{false};
  Sequence sequence(executor(), 5, 2);
  const FrameOutcome outcome = sequence.run(&stop);
  EXPECT_FALSE(outcome.interrupted);
  EXPECT_EQ(outcome.frames_written, 5);
}

TEST_P(FramePipeline, FailureWhileStoppingIsStillReported) {
  std::atomic<bool> stop{false};
  Sequence sequence(executor(), 100, 2, {{3, Step::kWrite}});
  sequence.after_write = [&](int frame) { stop = frame == 2; };
  // Frame 3 may have been read before `stop` was raised, or not.
  try {
    EXPECT_EQ(sequence.run(&stop).frames_written, 3);
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(error.what(), message(3, Step::kWrite));
  }
  EXPECT_EQ(sequence.written(), first_frames(3));
}

}  // namespace vantage::scheduler::frame_pipeline_test
