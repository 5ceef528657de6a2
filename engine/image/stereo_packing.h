#pragma once

#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/image/photograph.h"

namespace vantage {

/// Where both images of a pair are.
enum class StereoLayout {
  kSideBySide,
  kAboveBelow,
  kRows,     ///< rows take turns: a picture is twice as high as one image
  kColumns,  ///< columns take turns: twice as wide
  kFrames,   ///< pictures take turns: two of them are a pair
};

/// Layout of both images in one picture or in two successive ones, named as in ffmpeg's stereo3d
/// filter.
struct StereoPacking {
  StereoLayout layout = StereoLayout::kSideBySide;
  bool half_size = false;    ///< side by side, above-below: squeezed to half the width or height
  bool right_first = false;  ///< the right image is the left, the upper or the earlier one

  friend bool operator==(const StereoPacking&, const StereoPacking&) = default;
};

/// sbsl, sbsr, sbs2l, sbs2r, abl, abr, ab2l, ab2r, their synonyms tbl, tbr, tb2l, tb2r, and irl,
/// irr, icl, icr, al, ar.
const std::vector<std::pair<std::string_view, StereoPacking>>& stereo_packing_names();
/// The first name of `packing`.
std::string_view to_name(StereoPacking packing);

/// Splits `packed`, which is not kFrames, into its images. Images of half size are stretched to
/// full size by cubic interpolation (Catmull-Rom, clamped to the range of the type, or of the
/// pixels for float). Reuses the memory of the results. Throws Error when the size is not even in
/// the direction of the packing. Thread rule: concurrently for different results.
void unpack_stereo(const Photograph& packed, StereoPacking packing, Photograph& left,
                   Photograph& right);
/// unpack_stereo() for the left image alone.
void unpack_left(const Photograph& packed, StereoPacking packing, Photograph& left);

/// Throws Error unless both have the same size, depth and number of channels.
void require_equal_shapes(const Photograph& left, const Photograph& right);

/// Combines both images (equal size, depth and channels) into one, not kFrames. For half size each
/// pixel is the mean of two (the last one of an odd size counts twice). Throws Error when shapes
/// differ.
void pack_stereo(const Photograph& left, const Photograph& right, StereoPacking packing,
                 Photograph& packed);

}  // namespace vantage
