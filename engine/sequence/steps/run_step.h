#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>

#include "engine/execution.h"
#include "engine/image/memory_use.h"
#include "engine/sequence/options/sequence_layout.h"
#include "engine/sequence/options/sequence_options.h"
#include "engine/sequence/pairs/pair_shape.h"
#include "engine/sequence/pairs/pair_source.h"
#include "engine/sequence/shots/shots.h"
#include "engine/sequence/steps/frame_cameras.h"
#include "engine/sequence/steps/frame_slot.h"

namespace vantage {

/// What the steps of a run work with. All must outlive them.
struct FrameTools {
  const SequenceOptions& options;
  const SequenceLayout& layout;
  const PairSource& pairs;                ///< for decoding
  std::optional<ImageExtent> frame_size;  ///< required for all frames; empty: any
  FrameCameras cameras;
  const ShotTable* shots;  ///< null if the options need no shots
  bool writes_files;       ///< false: pictures are for a stream or a caller
  Execution& execution;
};

/// A step of a frame, made once per run. It depends on the frame and, if
/// TemporalOptions::uses_past(), on the frames before it in its chunk.
///
/// Thread rule: both functions concurrently for different slots, except in StepPhase::kCompute with
/// options that use the past: there one frame at a time, in order.
class RunStep {
 public:
  RunStep() = default;
  RunStep(const RunStep&) = delete;
  RunStep& operator=(const RunStep&) = delete;
  virtual ~RunStep() = default;

  /// Whether this frame, which the steps before it have made what it is, needs it.
  [[nodiscard]] virtual bool is_needed(const FrameSlot& slot) const = 0;
  /// Throws Error for a bad frame, OutputError for a result that cannot be written.
  virtual void run(FrameSlot& slot) = 0;
  /// Memory that it keeps beside the slots, at its maximum.
  virtual void add_memory_use(MemoryUse& use) const { (void)use; }
};

/// The part of the pipeline that a step belongs to: scheduler::FrameSteps.
enum class StepPhase : std::uint8_t { kRead, kPrepare, kCompute, kEncode, kWrite };

/// Kinds of work, to tell what threads wait for.
enum class WorkKind : std::uint8_t {
  kReading,    ///< reading or decoding images
  kComputing,  ///< anything else
  kWriting     ///< encoding or writing results
};

/// Memory that a step needs, planned before the run.
struct StepBytes {
  std::size_t of_frame = 0;  ///< of each frame in flight: what it leaves in the slot
  std::size_t of_work = 0;   ///< of each frame that is worked on, while the step runs
  std::size_t of_run = 0;    ///< kept for the whole run
};

/// All there is to know of a step; accounts, traces, memory plan and reports read it.
struct StepEntry {
  /// Of its time, in traces and reports; empty: it names its parts.
  std::string_view name;
  std::string_view account;  ///< of its processor time; steps may share one
  WorkKind kind = WorkKind::kComputing;
  StepPhase phase = StepPhase::kEncode;
  /// Null: the run itself does it, not the worker of a frame.
  std::unique_ptr<RunStep> (*make)(const FrameTools& tools) = nullptr;
  /// Null: none. Throws Error for what cannot be made.
  StepBytes (*planned_bytes)(const SequenceOptions& options, const PairShape& shape) = nullptr;
  /// What it has left in the slot; null: nothing.
  std::size_t (*held_bytes)(const FrameSlot& slot) = nullptr;
};

/// For StepEntry::make of a step that keeps something from frame to frame.
template <typename Step>
std::unique_ptr<RunStep> make_step(const FrameTools& tools) {
  return std::make_unique<Step>(tools);
}

/// For StepEntry::make of a step that keeps nothing: RunStep's functions.
template <bool (*kIsNeeded)(const FrameTools&, const FrameSlot&),
          void (*kRun)(const FrameTools&, FrameSlot&)>
std::unique_ptr<RunStep> make_step(const FrameTools& tools) {
  class FunctionStep final : public RunStep {
   public:
    explicit FunctionStep(const FrameTools& of_run) : tools_(of_run) {}
    [[nodiscard]] bool is_needed(const FrameSlot& slot) const override {
      return kIsNeeded(tools_, slot);
    }
    void run(FrameSlot& slot) override { kRun(tools_, slot); }

   private:
    FrameTools tools_;
  };
  return std::make_unique<FunctionStep>(tools);
}

}  // namespace vantage
