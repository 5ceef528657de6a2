#pragma once

#include <array>
#include <cstdint>

namespace vantage::kernels {

// Chroma of 4:2:0 (8 bits; beside every second column, between two rows) for every pixel, by the
// cubic with B = 0, C = 0.6: to the bit what libswscale 6 makes with SWS_BICUBIC for planes of 16
// bits. First along the columns, then along the rows. Identical on every instruction set.

/// columns[2i] = 2048 · samples[i], columns[2i + 1] = (9421 · (samples[i] + samples[i + 1]) − 1229
/// · (samples[i − 1] + samples[i + 2])) / 8, rounded down and at most 2^19 − 1, i in [0, count);
/// the first and the last sample stand for those outside.
void chroma_columns(const std::uint8_t* samples, int count, std::int32_t* columns);

/// Four rows of chroma_columns(), around a row of pixels, from above; and what they weigh of 2^12.
using ChromaSourceRows = std::array<const std::int32_t*, 4>;
using ChromaWeights = std::array<std::int32_t, 4>;

/// chroma[x] = the sum of weights[k] · rows[k][x] / 2^15, rounded and clamped to 0..65535, x in
/// [0, width). Weights add up to 2^12, negative ones to −512 at least.
void chroma_row(const ChromaSourceRows& rows, const ChromaWeights& weights, int width,
                std::uint16_t* chroma);

/// For a row of pixels above its nearest row of samples, rows[2]; below it (rows[1]) in reverse.
inline constexpr ChromaWeights kChromaWeights = {-115, 985, 3572, -346};

}  // namespace vantage::kernels
