#pragma once

#include <cstdint>

namespace vantage::kernels {

/// Grey levels in 0..255, rounded to whole ones; ties to even.
void rounded_intensity_row(const float* intensities, int width, std::uint8_t* rounded);
void rounded_intensity_row_ref(const float* intensities, int width, std::uint8_t* rounded);

/// A row of an image of half the size, (width + 1)/2 columns: each the mean of 2×2 pixels of two
/// rows, halves rounded up. A missing column repeats the last one.
void halved_intensity_row(const std::uint8_t* upper, const std::uint8_t* lower, int width,
                          std::uint8_t* halved);
void halved_intensity_row_ref(const std::uint8_t* upper, const std::uint8_t* lower, int width,
                              std::uint8_t* halved);

}  // namespace vantage::kernels
