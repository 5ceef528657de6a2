#pragma once

#include <cstdint>

#include "engine/image/photograph.h"

namespace vantage {

/// A hash of size, depth, channels and all pixels; equal for equal pictures on little-endian
/// machines, with a collision probability of about 2⁻⁶⁴. For finding repeated frames, not for
/// storing. Thread rule: pure.
std::uint64_t content_hash(const Photograph& photograph);

/// Whether two photographs have the same size, depth, channels and pixels. Thread rule: pure.
bool have_same_pixels(const Photograph& a, const Photograph& b);

}  // namespace vantage
