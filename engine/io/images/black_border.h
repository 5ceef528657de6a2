#pragma once

#include "engine/image/image.h"
#include "engine/image/photograph.h"

namespace vantage {

/// Raises `brightest` to the grey levels of a picture, or makes it them if it has another size.
/// What stays dark in several pictures of a film is no shadow.
void take_brightest(const Photograph& photograph, Image<std::uint8_t>& brightest);

/// Pixels at the borders of a picture that are not scene: 255 where bars of a film or wedges of a
/// rectification are; empty: there are none. They are black, reach the border, leave a picture
/// whose outline has few corners, and end sharply at something that is not black. Dark scenes,
/// vignettes and shadows do not.
Mask black_border(const Image<std::uint8_t>& brightest);
Mask black_border(const Photograph& photograph);

}  // namespace vantage
