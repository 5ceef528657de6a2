#pragma once

namespace vantage {

/// Whether this build has OpenCV: false for the core alone, which has no match_features() and no
/// inpaint_background().
bool has_opencv();

}  // namespace vantage
