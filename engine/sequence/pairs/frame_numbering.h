#pragma once

#include <string>
#include <vector>

#include "engine/io/video/frame_source.h"

namespace vantage {

/// Frames of a source: `first_frame` and the `count` − 1 after it.
struct FrameSpan {
  const FrameSource& source;
  int first_frame = 0;
  int count = 0;
};

/// Remarks on the file numbers of one sequence, one line each: missing or duplicate numbers. None
/// if the numbers do not increase evenly (time stamps, say) or there are none.
std::vector<std::string> numbering_remarks(const FrameSpan& frames);

/// Remarks on numbers that are missing among those of all frames of several cameras, likewise.
std::vector<std::string> numbers_missing_on_both(const std::vector<double>& numbers);

/// Whether the numbers of two sequences (of equal count) both increase evenly, by the same, but not
/// alike: paired by index, they are not of the same moments from some pair on.
bool numbers_shift(const FrameSpan& left, const FrameSpan& right);

/// Remarks on the file numbers of two sequences (of equal count) paired by index: gaps in both are
/// dropped frames; a gap in only one shifts the pairs after it.
std::vector<std::string> numbering_remarks(const FrameSpan& left, const FrameSpan& right);

}  // namespace vantage
