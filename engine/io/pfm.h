#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "engine/image/image.h"
#include "engine/io/file_bytes.h"

namespace vantage {

/// Decodes a PFM file ("Pf": 1 channel, "PF": 3 channels; rows stored bottom-up; either byte
/// order). Values come out as they are stored: the magnitude of the scale line is not applied, as
/// is usual for disparities. Throws Error for anything else or too short a payload.
Image<float> decode_pfm(const FileBytes& file);

/// Encodes 1 or 3 channels into `bytes`, whose memory is reused: little-endian, scale 1. `unknown`
/// is stored for NaN and ±inf; without it they are stored as they are.
void encode_pfm(ImageView<const float> image, std::vector<std::uint8_t>& bytes,
                std::optional<float> unknown = std::nullopt);

}  // namespace vantage
