#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "engine/image/photograph.h"
#include "engine/io/file_bytes.h"

namespace vantage {

/// An image file's values as they are stored: PNM not stretched to its largest value, floats of any
/// value, NaN too.
struct DecodedImage {
  Photograph photograph;
  int max_value = 255;  ///< of integer values
};

/// Decodes an image of any format that read_photograph() knows. Throws Error, also when
/// memory does not suffice.
/// The image takes the memory of `memory` where that has its depth and size.
DecodedImage decode_image(const FileBytes& file, Photograph memory = {});

/// Makes `bytes`, whose memory is reused, those of an image file of the format that the extension
/// of `path` says. Floats of any value. Throws UsageError for an unknown extension, Error when the
/// format cannot hold the depth or channels; both name `path`.
void encode_image(const std::filesystem::path& path, const Photograph& photograph,
                  std::vector<std::uint8_t>& bytes);

}  // namespace vantage
