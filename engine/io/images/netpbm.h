#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "engine/image/image.h"
#include "engine/image/photograph.h"
#include "engine/io/files/file_bytes.h"

namespace vantage {

// Our own readers and writers, because OpenCV stretches PNM values to the range of their type,
// applies the scale of a PFM, and knows neither values above the maximum of a header nor truncated
// data.

/// A PNM file's values as stored, 0..max_value, 8-bit up to 255 and 16-bit above. Bitmaps become 0
/// (black) and 255.
struct PnmImage {
  Photograph photograph;
  int max_value = 255;
};

/// Decodes PBM, PGM and PPM, text or binary (P1..P6). Throws Error.
PnmImage decode_pnm(const FileBytes& file);

/// Encodes 8- or 16-bit, 1 channel as P5, 3 channels as P6.
std::vector<std::uint8_t> encode_pnm(const Photograph& photograph);

/// Decodes a PFM file ("Pf": 1 channel, "PF": 3 channels; rows stored bottom-up; either byte
/// order). Returns the stored values: the magnitude of the scale line is not applied, as is usual
/// for disparities. Throws Error for anything else or a truncated payload.
Image<float> decode_pfm(const FileBytes& file);

/// Encodes 1 or 3 channels into `bytes`, whose memory is reused: little-endian, scale 1. `unknown`
/// replaces NaN and ±inf; if empty they are stored unchanged.
void encode_pfm(ImageView<const float> image, std::vector<std::uint8_t>& bytes,
                std::optional<float> unknown = std::nullopt);

}  // namespace vantage
