#pragma once

#include <functional>

#include "apps/run/run_settings.h"
#include "engine/sequence/sequence_runner.h"

namespace vantage::apps {

/// work(run). With --show, which needs the main thread, `work` runs in another one while a window
/// shows the newest map and, beside it, the first view or else the left image. Closing the window
/// ends the run as Ctrl-C does: frames in flight are finished.
SequenceReport beside_window(const RunJob& job, SequenceRun run,
                             const std::function<SequenceReport(const SequenceRun&)>& work);

}  // namespace vantage::apps
