#include "engine/sequence/stream_runner.h"

#include <fmt/format.h>

#include <utility>

#include "engine/error.h"
#include "engine/sequence/frame_flow.h"
#include "engine/sequence/journal/commit_queue.h"
#include "engine/sequence/run_totals.h"
#include "engine/sequence/steps/frame_pictures.h"
#include "scheduler/interruption.h"

namespace vantage {
namespace {

class StreamRun final : private FrameFlow {
 public:
  StreamRun(const SequenceOptions& options, const SequenceRun& run, const SequenceLayout& layout,
            StreamedVideoWriter& writer, Execution& execution)
      : FrameFlow(options, layout, run,
                  {run_of(run.selection, dependence_of(options, layout), run.selection.own())},
                  false, execution),
        reference_(options.match.reference),
        writer_(writer) {}

  SequenceReport work() {
    try {
      const scheduler::FrameOutcome outcome = flow(run().stop);
      // Where the source is a stream, it has ended early.
      report_.interrupted = outcome.interrupted || (run().pairs.is_stream() &&
                                                    run().stop != nullptr && run().stop->load());
    } catch (const scheduler::Interrupted&) {  // the reader did not take the rest
      report_.interrupted = true;
    }
    add_totals(report_);
    return std::move(report_);
  }

 private:
  void write(std::unique_ptr<FrameSlot>& slot) override {
    if (slot->is_lead_in || slot->is_absent) {
      return;
    }
    copy_picture(*slot, layout().streams().front(), reference_, last_);
    put_last();
    has_last_ = true;
    add_frame(report_, *slot);
    for (const std::string& remark : slot->pair.remarks) {
      report_.remarks.push_back({slot->frame, remark});
    }
    tell_progress(1, slot->match.cells);
  }

  [[noreturn]] void give_up(const FrameSlot& slot, const std::string& name,
                            const std::string& problem) override {
    if (problem.starts_with(name)) {
      throw Error(problem);  // problems of a stream name their frame
    }
    FrameFlow::give_up(slot, name, problem);
  }

  void skip(FrameSlot& slot, const std::string& name, const std::string& problem) override {
    report_.skipped.push_back({slot.frame, fmt::format("{}: {}", name, problem)});
    if (has_last_) {
      put_last();
    }
    tell_progress(1, 0);
  }

  void put_last() {
    try {
      writer_.write(last_);
    } catch (const Error& error) {
      throw DeliveryError(error.what());
    }
  }

  Side reference_;
  StreamedVideoWriter& writer_;
  Photograph last_;
  bool has_last_ = false;
  SequenceReport report_;
};

}  // namespace

SequenceReport run_stream(const SequenceOptions& options, const SequenceRun& run,
                          StreamedVideoWriter& writer, Execution& execution) {
  const SequenceLayout layout("-", options);
  return StreamRun(options, run, layout, writer, execution).work();
}

}  // namespace vantage
