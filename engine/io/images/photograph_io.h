#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "engine/image/photograph.h"
#include "engine/image/photograph_reading.h"
#include "engine/io/files/file_bytes.h"

namespace vantage {

class Execution;

/// The stored values of an image file: PNM is not stretched to its maximum value, floats may have
/// any value, including NaN.
struct DecodedImage {
  Photograph photograph;
  int max_value = 255;  ///< of integer values
  /// Floats were stored as integers of so many bits, with a sign if they are 16 or fewer; 0: they
  /// were not.
  int integer_bits = 0;
  std::optional<double> no_data = {};  ///< the value of pixels without data, where the file has one
};

/// Decodes an image of any format that read_photograph() supports. Reuses `memory` if it has the
/// image's depth and size. Throws Error, also when out of memory.
DecodedImage decode_image(const FileBytes& file, const PhotographReading& reading = {},
                          Photograph memory = {});

/// Encodes an image file to `bytes`, whose memory is reused, in the format given by the extension
/// of `path`. Floats of any value. Throws UsageError for an unknown extension, Error when the
/// format cannot hold the depth or channels; both name `path`. `execution`: encode_png().
void encode_photograph(const std::filesystem::path& path, const Photograph& photograph,
                       std::vector<std::uint8_t>& bytes, Execution* execution = nullptr);

/// Reads PNG, JPEG, TIFF, PNM, BMP, WebP, EXR (by OpenCV) and PFM: 8-bit, 16-bit and float; grey,
/// RGB or RGBA. The file's content determines the format, not its name. FILE#N is page N of a file
/// of several, counted from 0 (io/files/numbered_part.h). PNM values are stretched
/// from the file's maximum value to the type's. Turned as its EXIF orientation (JPEG, PNG, WebP,
/// TIFF) says; gamma and colour profiles are ignored. Reuses `memory` if it has the photograph's
/// depth and size. Throws Error naming the file when it is missing, empty, truncated, not an image,
/// too large according to its header, or float with infinity. Pixels without data (NaN, or what a
/// TIFF file states) are left out (image/left_out.h). What was assumed is in the origin's remarks.
/// Thread rule: may be called concurrently.
Photograph read_photograph(const std::filesystem::path& path, const PhotographReading& reading = {},
                           Photograph memory = {});

/// Writes by extension (.png .jpg .tiff .bmp .ppm .pgm .webp .exr .pfm), atomically. Throws Error
/// when the folder cannot be written or the format cannot hold the depth or channels, UsageError
/// for an unknown extension. `execution`: encode_png(). Thread rule: may be called concurrently.
void write_photograph(const std::filesystem::path& path, const Photograph& photograph,
                      Execution* execution = nullptr);

/// Writes a mask as 8-bit grey PNG, atomically. Throws as write_photograph() does.
void write_mask(const std::filesystem::path& path, ImageView<const std::uint8_t> mask,
                Execution* execution = nullptr);

}  // namespace vantage
