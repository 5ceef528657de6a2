#pragma once

#include <cstdint>
#include <optional>

#include "engine/image/image.h"
#include "engine/io/images/preview.h"
#include "engine/sequence/shots/shots.h"

namespace vantage {

/// The disparities searched in any shot. `film`, `shots`: as of depth_range_of().
DisparityRange searched_in_all(DisparityRange film, const ShotTable* shots);

/// The disparities of the darkest and of the brightest level in the frames of a shot. `film`: the
/// search range of the run; `shots`: null where all are searched in it.
PreviewRange depth_range_of(const DepthVideoScale& scale, DisparityRange film,
                            const ShotTable* shots, int frame);

/// The disparities of the first and the last colour of a frame's preview. `of_pair`: searched in
/// its pair, if that has a range of its own.
PreviewRange preview_range_of_frame(const SequenceOptions& options, const ShotTable* shots,
                                    int frame, const std::optional<DisparityRange>& of_pair);

/// Disparities as 16-bit levels: 0 is unknown, 1 to 65535 are `range.min_px` to `range.max_px`,
/// rounded; disparities outside are clamped. Near is bright. `picture` is reused.
void paint_depth(ImageView<const float> map_px, PreviewRange range, Image<std::uint16_t>& picture);

}  // namespace vantage
