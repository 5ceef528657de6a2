#include "engine/io/images/stereo_jpeg.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <string_view>
#include <utility>

#include "engine/error.h"
#include "engine/io/images/jpeg_decoder.h"

namespace vantage {
namespace {

constexpr std::endian kBigEndian = std::endian::big;
constexpr int kStartOfScan = 0xDA;
constexpr int kIndexSegment = 0xE2;
constexpr int kJpsSegment = 0xE3;
constexpr std::string_view kIndexName("MPF\0", 4);
constexpr std::string_view kJpsName = "_JPSJPS_";

/// Where the contents of a segment with this name begin, after the name; 0: there is none. Only
/// those before the picture count.
std::size_t find_segment(const FileBytes& file, int wanted, std::string_view name) {
  std::size_t offset = 2;
  while (file.has_at(offset, "\xFF") && file.byte(offset + 1) != kStartOfScan) {
    if (file.byte(offset + 1) == wanted && file.has_at(offset + 4, name)) {
      return offset + 4 + name.size();
    }
    offset += 2 + std::size_t{file.integer<std::uint16_t>(offset + 2, kBigEndian)};
  }
  return 0;
}

/// The images that the index of an MPO lists. Its offsets are from `base`, where it begins.
std::vector<std::span<const std::uint8_t>> listed_images(const FileBytes& file, std::size_t base,
                                                         bool is_mpo) {
  constexpr int kEntries = 0xB002;
  constexpr std::uint32_t kTypeOfEntry = 0xFFFFFF;
  constexpr std::uint32_t kDisparity = 0x020002;
  constexpr std::uint32_t kThumbnails = 0x01;  // in the third byte
  constexpr std::size_t kEntryBytes = 16;
  const std::endian order = file.has_at(base, "II") ? std::endian::little : kBigEndian;
  const auto number = [&](std::size_t offset) {
    return std::size_t{file.integer<std::uint32_t>(offset, order)};
  };
  const std::size_t directory = base + number(base + 4);
  const int fields = file.integer<std::uint16_t>(directory, order);
  std::vector<std::span<const std::uint8_t>> images;
  bool has_disparity = is_mpo;
  for (int i = 0; i < fields; ++i) {
    const std::size_t field = directory + 2 + 12 * static_cast<std::size_t>(i);
    if (file.integer<std::uint16_t>(field, order) != kEntries) {
      continue;
    }
    const std::size_t entries = number(field + 4) / kEntryBytes;
    for (std::size_t k = 0; k < entries; ++k) {
      const std::size_t entry = base + number(field + 8) + k * kEntryBytes;
      const std::uint32_t type = file.integer<std::uint32_t>(entry, order) & kTypeOfEntry;
      has_disparity = has_disparity || type == kDisparity;
      if (type >> 16U != kThumbnails) {
        images.push_back(file.part(k == 0 ? 0 : base + number(entry + 8), number(entry + 4)));
      }
    }
  }
  return has_disparity ? images : std::vector<std::span<const std::uint8_t>>();
}

/// The stereoscopic descriptor: separation, flags, layout, kind of picture.
std::optional<StereoPacking> packing_of_marker(const FileBytes& file, std::size_t descriptor) {
  const unsigned flags = file.byte(descriptor + 1);
  const int layout = file.byte(descriptor + 2);
  if (file.byte(descriptor + 3) != 1) {
    return std::nullopt;  // a single image
  }
  if (layout < 1 || layout > 3) {
    file.fail(
        "is a JPS picture of both images in one (anaglyph), expected images side by side, "
        "above each other or in rows");
  }
  constexpr StereoLayout kLayouts[] = {StereoLayout::kRows, StereoLayout::kSideBySide,
                                       StereoLayout::kAboveBelow};
  return StereoPacking{.layout = kLayouts[layout - 1],
                       .half_size = (flags & 3U) != 0 && layout != 1,
                       .right_first = (flags & 4U) == 0};
}

}  // namespace

StereoJpeg stereo_jpeg(const FileBytes& file) {
  StereoJpeg stereo;
  const std::string extension = lower_case_extension(file.name());
  if (const std::size_t base = find_segment(file, kIndexSegment, kIndexName); base > 0) {
    stereo.images = listed_images(file, base, extension == ".mpo");
  }
  if (stereo.images.size() < 2) {
    stereo.images = {file.all()};
  }
  if (const std::size_t marker = find_segment(file, kJpsSegment, kJpsName); marker > 0) {
    stereo.packing = packing_of_marker(file, marker + 2);
  } else if (extension == ".jps") {
    stereo.packing = StereoPacking{.right_first = true};
    stereo.remark =
        "a JPS file says nothing of its halves: the left one is taken for the right image, as is "
        "usual (FILE#1 FILE#0, or `packing` sbsl of a run, for the other order)";
  }
  return stereo;
}

bool is_stereo_jpeg(const std::filesystem::path& path) {
  try {
    const std::vector<std::uint8_t> bytes = read_file_bytes(path);
    const FileBytes file(bytes, path.string());
    return detect_image_format(file) == ImageFormat::kJpeg && stereo_jpeg(file).views() > 1;
  } catch (const Error&) {
    return false;
  }
}

Photograph decode_jpeg_view(const FileBytes& file, const PhotographReading& reading,
                            Photograph& memory, StatedByFile& stated) {
  const StereoJpeg stereo = stereo_jpeg(file);
  const int views = stereo.views();
  const int view = reading.page.value_or(0);
  if (view >= views) {
    file.fail(fmt::format("has {} image{}, expected number {} to be below that", views,
                          views == 1 ? "" : "s", view));
  }
  const FileBytes image(stereo.images[stereo.packing ? 0 : static_cast<std::size_t>(view)],
                        file.name());
  if (!image.has_at(0, "\xFF\xD8")) {
    file.fail(fmt::format("is damaged, its image {} is not where its index says", view));
  }
  stated = check_image_header(image, ImageFormat::kJpeg);
  Photograph photograph = decode_jpeg(image, memory);
  if (reading.page && stereo.packing) {
    Photograph half;
    StereoPacking packing = *stereo.packing;
    packing.right_first = packing.right_first != (view == 1);  // the wanted one is then the left
    unpack_left(photograph, packing, half);
    photograph = std::move(half);
  }
  std::string remark = reading.page ? stereo.remark : "";
  if (!reading.page && stereo.images.size() > 1) {
    remark = fmt::format("the first of {} images is read (FILE#1 names the next)", views);
  }
  if (!remark.empty()) {
    photograph.origin.remarks.push_back({Remark::Kind::kNote, "pages", remark});
  }
  return photograph;
}

}  // namespace vantage
