#pragma once

#include "engine/execution.h"
#include "engine/io/video/writing/streamed_video_writer.h"
#include "engine/sequence/sequence_runner.h"

namespace vantage {

/// Runs a sequence whose only output, one picture per frame, goes to `writer` as it is made:
/// nothing is stored, nothing can be resumed, and the end of the input need not be known. Frames as
/// of SequenceRunner; `run.selection` selects them, `run.shots` must be null. A frame that fails
/// ends the run, unless run.keep_going: then the one before it is shown again (none at the start).
/// Bytes are identical for any ExecutionOptions and in-flight count. Throws as
/// SequenceRunner::run().
SequenceReport run_stream(const SequenceOptions& options, const SequenceRun& run,
                          StreamedVideoWriter& writer, Execution& execution);

}  // namespace vantage
