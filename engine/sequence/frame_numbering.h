#pragma once

#include <string>
#include <vector>

#include "engine/io/frame_source.h"

namespace vantage {

/// Frames of a source that are looked at: `first_frame` and the `count` − 1 behind it.
struct FrameSpan {
  const FrameSource& source;
  int first_frame = 0;
  int count = 0;
};

/// What the numbers in the file names say about one sequence, a line each: numbers that are missing
/// or there twice. Nothing where the numbers do not count up evenly (times of recording, say) or
/// where there are none.
std::vector<std::string> numbering_remarks(const FrameSpan& frames);

/// The same for two sequences (of equal count) whose frames are paired by index: gaps that both
/// have are dropped frames; where only one has a gap, pairs from there on are not of the same
/// moment.
std::vector<std::string> numbering_remarks(const FrameSpan& left, const FrameSpan& right);

}  // namespace vantage
