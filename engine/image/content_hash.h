#pragma once

#include <cstdint>

#include "engine/image/photograph.h"

namespace vantage {

/// A number that differs for pictures that differ in size, depth, channels or any pixel, but for a
/// chance of about 2⁻⁶⁴; the same for equal ones, on little-endian machines. For finding repeated
/// frames, not for keeping. Thread rule: pure.
std::uint64_t content_hash(const Photograph& photograph);

}  // namespace vantage
