#pragma once

#include <filesystem>
#include <optional>

namespace vantage::apps {

/// What the start of an image file says.
struct PictureHeader {
  int width_px = 0;
  int height_px = 0;
  int bits = 8;  ///< of a channel
};

/// Of a PNG or JPEG file, local or at an address; empty for other formats and where it cannot be
/// read. Nothing is decoded.
std::optional<PictureHeader> read_picture_header(const std::filesystem::path& file);

}  // namespace vantage::apps
