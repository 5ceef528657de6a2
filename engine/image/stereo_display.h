#pragma once

#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "engine/image/photograph.h"
#include "engine/image/stereo_packing.h"

namespace vantage {

/// One picture for two-colour filter glasses, left first.
enum class Anaglyph { kRedCyan, kGreenMagenta, kYellowBlue };

/// How a viewer's single picture is made from both images of a pair.
using StereoDisplay = std::variant<StereoPacking, Anaglyph>;

/// Names as in ffmpeg's stereo3d filter: those of stereo_packing_names() of one picture; arcd, agmd
/// and aybd (Dubois anaglyphs).
const std::vector<std::pair<std::string_view, StereoDisplay>>& stereo_display_names();

/// Combines both images (equal size, depth and channels) into one. Anaglyphs weigh the channels of
/// both by the least-squares projection of E. Dubois, 2001, applied to the encoded values; grey
/// images count as equal R, G and B, alpha is averaged. Anaglyphs have at least three channels.
/// Reuses the memory of the result. Throws Error when shapes differ. Thread rule: concurrently for
/// different results.
void show_stereo(const Photograph& left, const Photograph& right, const StereoDisplay& display,
                 Photograph& shown);

}  // namespace vantage
