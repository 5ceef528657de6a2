#pragma once

#include "engine/image/image.h"
#include "engine/image/photograph.h"
#include "engine/library/vantage_c.h"

namespace vantage {

// Pixels in the caller's memory. All throw UsageError for NULL, a layout that there is not, and
// fields that this library does not know; they name `name`. Thread rule: pure.

/// A copy.
Photograph photograph_of(const vantage_image* image, const char* name);

/// `map` goes to a picture of its size, with one channel of 32 bits.
void write_map(const Image<float>& map, const vantage_picture* picture);
/// `photograph` goes to a picture of its size, channels and bits.
void write_photograph(const Photograph& photograph, const vantage_picture* picture);

}  // namespace vantage
