#include "engine/io/images/exif.h"

#include <bit>
#include <string_view>

#include "engine/error.h"
#include "engine/io/files/file_bytes.h"

namespace vantage {

Orientation exif_orientation(std::span<const std::uint8_t> exif) {
  constexpr int kTag = 274;
  try {
    constexpr std::string_view kPrefix("Exif\0\0", 6);  // WebP files of some programs have it, too
    const FileBytes all(exif, "");
    const FileBytes tags(exif.subspan(all.has_at(0, kPrefix) ? kPrefix.size() : 0), "");
    const std::endian order = tags.has_at(0, "II") ? std::endian::little : std::endian::big;
    const std::size_t directory = tags.integer<std::uint32_t>(4, order);
    const int entries = tags.integer<std::uint16_t>(directory, order);
    for (int i = 0; i < entries; ++i) {
      const std::size_t entry = directory + 2 + 12 * static_cast<std::size_t>(i);
      if (tags.integer<std::uint16_t>(entry, order) == kTag) {
        return orientation_of_tag(tags.integer<std::uint16_t>(entry + 8, order));
      }
    }
  } catch (const Error&) {  // damaged: as if there were none; no pixel depends on it
  }
  return Orientation::kAsStored;
}

}  // namespace vantage
