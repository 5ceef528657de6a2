#pragma once

#include "engine/io/images/preview.h"
#include "engine/matching/options/match_options.h"

namespace vantage {

/// Previews of one search range share their colours, independent of the content: the range itself,
/// half a pixel wider on both sides (so that a single candidate has a span too).
inline PreviewRange preview_range_of(DisparityRange search) {
  return {static_cast<float>(search.min) - 0.5F, static_cast<float>(search.max) + 0.5F};
}

}  // namespace vantage
