#pragma once

#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "engine/image/photograph.h"
#include "engine/image/stereo_packing.h"

namespace vantage {

/// One picture for glasses with filters of two colours, left first.
enum class Anaglyph { kRedCyan, kGreenMagenta, kYellowBlue };

/// Rows (or columns) of both images in turn, all of them: twice as high (wide) as one image.
struct InterleavedStereo {
  bool columns = false;
  bool right_first = false;

  friend bool operator==(const InterleavedStereo&, const InterleavedStereo&) = default;
};

/// How both images of a pair become one picture for a viewer.
using StereoDisplay = std::variant<StereoPacking, Anaglyph, InterleavedStereo>;

/// With the names of ffmpeg's stereo3d filter: those of stereo_packing_names(); arcd, agmd and aybd
/// (anaglyphs after Dubois); irl, irr, icl and icr (interleaved).
const std::vector<std::pair<std::string_view, StereoDisplay>>& stereo_display_names();

/// Puts both images (equal size, depth and channels) into one. Anaglyphs weigh the channels of both
/// by the least-squares projection of E. Dubois, 2001, in the encoded values as they are; grey
/// images count as equal R, G and B, an alpha channel is the mean. They have three channels at
/// least. Throws Error when shapes differ. Memory of the result is reused. Thread rule:
/// concurrently for different results.
void show_stereo(const Photograph& left, const Photograph& right, const StereoDisplay& display,
                 Photograph& shown);

}  // namespace vantage
