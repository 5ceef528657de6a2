#pragma once

#include <optional>
#include <string>

#include "engine/comfort/comfort_summary.h"
#include "engine/sequence/journal/delivered_frames.h"
#include "engine/sequence/journal/run_journal.h"
#include "engine/sequence/options/sequence_layout.h"
#include "engine/sequence/options/sequence_options.h"

namespace vantage::apps {

/// Writes what belongs to all of `frames`, which are done: depth-video.json, comfort.json and
/// comfort.html, as far as `options` save them, and records it. Identical for any division of the
/// run. Returns the report on comfort, if it is saved and a frame was measured. Throws Error.
std::optional<ComfortReport> write_film_reports(const SequenceOptions& options,
                                                const SequenceLayout& layout, FrameRange frames,
                                                RunJournal& journal);

/// Tells what the report says of the film on stderr, in a few lines.
void print_comfort(const std::string& command, const ComfortReport& report,
                   const SequenceLayout& layout);

}  // namespace vantage::apps
