#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "engine/image/image.h"
#include "engine/io/files/file_bytes.h"

namespace vantage {

/// Decodes a PFM file ("Pf": 1 channel, "PF": 3 channels; rows stored bottom-up; either byte
/// order). Returns the stored values: the magnitude of the scale line is not applied, as is usual
/// for disparities. Throws Error for anything else or a truncated payload.
Image<float> decode_pfm(const FileBytes& file);

/// Encodes 1 or 3 channels into `bytes`, whose memory is reused: little-endian, scale 1. `unknown`
/// replaces NaN and ±inf; if empty they are stored unchanged.
void encode_pfm(ImageView<const float> image, std::vector<std::uint8_t>& bytes,
                std::optional<float> unknown = std::nullopt);

}  // namespace vantage
