#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "engine/image/photograph.h"
#include "engine/io/files/file_bytes.h"

namespace vantage {

/// The stored values of an image file: PNM is not stretched to its maximum value, floats may have
/// any value, including NaN.
struct DecodedImage {
  Photograph photograph;
  int max_value = 255;  ///< of integer values
};

/// Decodes an image of any format that read_photograph() supports. Reuses `memory` if it has the
/// image's depth and size. Throws Error, also when out of memory.
DecodedImage decode_image(const FileBytes& file, Photograph memory = {});

/// Encodes an image file to `bytes`, whose memory is reused, in the format given by the extension
/// of `path`. Floats of any value. Throws UsageError for an unknown extension, Error when the
/// format cannot hold the depth or channels; both name `path`.
void encode_image(const std::filesystem::path& path, const Photograph& photograph,
                  std::vector<std::uint8_t>& bytes);

}  // namespace vantage
