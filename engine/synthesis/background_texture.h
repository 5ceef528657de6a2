#pragma once

#include <cstddef>
#include <cstdint>

#include "engine/execution.h"
#include "engine/image/image.h"

namespace vantage {

/// Continues the texture of the background into the `wanted` pixels (255, else 0) of an image,
/// patch by patch (EQUATIONS §6; A. Criminisi, P. Pérez and K. Toyama, 2004). `disparity_px`, of
/// the image's size: at wanted pixels, of the background there, NaN if unknown. Pixels nearer than
/// that by more than the limit are neither continued nor copied. Wanted pixels without a source
/// keep their values; other pixels are unchanged. Values are copied, never mixed. The step of the
/// search grows with the number of wanted pixels, so that time is bounded. Identical for any
/// `execution`. T is uint8_t, uint16_t or float.
template <typename T>
void synthesize_background_texture(ImageView<T> image, ImageView<const std::uint8_t> wanted,
                                   ImageView<const float> disparity_px, double gradient_limit_px,
                                   Execution& execution);

/// Working memory for an image of this shape, in bytes.
std::size_t texture_synthesis_bytes(int width, int height);

}  // namespace vantage
