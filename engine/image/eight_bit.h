#pragma once

#include <cstdint>

#include "engine/image/photograph.h"

namespace vantage {

/// The photograph without alpha, 1 or 3 channels, as 8-bit grey levels: for screens. Values outside
/// 0..255 are clipped. Thread rule: pure.
Image<std::uint8_t> eight_bit(const Photograph& photograph);

}  // namespace vantage
