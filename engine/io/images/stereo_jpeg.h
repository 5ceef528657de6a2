#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/image/photograph.h"
#include "engine/image/photograph_reading.h"
#include "engine/image/stereo_packing.h"
#include "engine/io/files/file_bytes.h"
#include "engine/io/images/image_header.h"

namespace vantage {

/// The views of a file of a stereo camera: MPO (CIPA DC-007) is several JPEG files in one, the left
/// view first; JPS (VRex) is one whose picture holds both.
struct StereoJpeg {
  std::vector<std::span<const std::uint8_t>> images;  ///< one unless it is an MPO
  std::optional<StereoPacking> packing = {};          ///< of a JPS
  std::string remark = {};                            ///< what was assumed of it

  [[nodiscard]] int views() const { return packing ? 2 : static_cast<int>(images.size()); }
};

/// What a JPEG file holds. An MPO is recognised by an index that says so, or by its extension and
/// any index; thumbnails in the index are no views. A JPS by its marker, or by its extension: the
/// right image is then taken to be the left half, as programs without a marker have it. Throws
/// Error for a damaged index, and for a JPS of a layout that is not read.
StereoJpeg stereo_jpeg(const FileBytes& file);

/// Whether the file is an MPO or JPS; false for what cannot be read. Thread rule: may be called
/// concurrently.
bool is_stereo_jpeg(const std::filesystem::path& path);

/// The pixels of a JPEG file, as stored, or of its view reading.page. Throws Error as decode_jpeg()
/// and stereo_jpeg() do.
Photograph decode_jpeg_view(const FileBytes& file, const PhotographReading& reading,
                            Photograph& memory, StatedByFile& stated);

}  // namespace vantage
