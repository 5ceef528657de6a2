#pragma once

#include <cstdint>

namespace vantage::kernels {

/// levels[x] = the grey level of an 8-bit pixel, x in [0, width): the value itself of one channel;
/// of three or four the luma (77 R + 150 G + 29 B) / 256, rounded, alpha left out. For comparing
/// frames with each other; matching takes luma that is not rounded. channels is 1, 3 or 4. Equal to
/// the reference on every instruction set.
void luma_levels_row(const std::uint8_t* pixels, int width, int channels, std::uint8_t* levels);
void luma_levels_row_ref(const std::uint8_t* pixels, int width, int channels, std::uint8_t* levels);

}  // namespace vantage::kernels
