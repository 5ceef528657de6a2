#pragma once

#include <string>

#include "apps/process/progress.h"
#include "engine/options/setting_value.h"
#include "engine/sequence/journal/delivered_frames.h"
#include "engine/sequence/journal/run_verification.h"
#include "engine/sequence/options/sequence_layout.h"

namespace vantage::apps {

/// verify_run() with progress on stderr under the name of `command`, ended by signals.
RunVerification verify_with_progress(const SequenceLayout& layout, const std::string& command,
                                     ProgressStyle style);

/// Reads the files of `frames` before they are taken for results of the whole run, with progress on
/// stderr under the name of `command`. False when interrupted. Throws Error naming the first file
/// that has changed.
bool require_unchanged_frames(const SequenceLayout& layout, const DeliveredFrames& delivered,
                              FrameRange frames, const std::string& command, ProgressStyle style);

/// For reports.
SettingValue to_value(const RunVerification& verification);

/// The first problem of the run in `folder`, in one line that names the file.
std::string describe_damage(const RunVerification& verification, const std::string& folder);

}  // namespace vantage::apps
