#include "engine/io/images/stated_white_level.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <span>

namespace vantage {
namespace {

constexpr double kWhite = 65535;

unsigned largest_value(const Photograph& photograph) {
  const auto& image = std::get<Image<std::uint16_t>>(photograph.pixels);
  unsigned largest = 0;
  for (int y = 0; y < image.height(); ++y) {
    largest = std::max<unsigned>(
        largest, *std::max_element(image.row(y), image.row(y) + image.width() * image.channels()));
  }
  return largest;
}

bool has_16_bits(const Photograph& photograph) {
  return std::holds_alternative<Image<std::uint16_t>>(photograph.pixels);
}

double largest_of_bits(unsigned value) { return (1U << std::bit_width(value)) - 1.0; }

/// Fields of the first directory; 0: there is none.
struct TiffFields {
  unsigned bits_per_sample = 0;
  unsigned max_sample_value = 0;
  unsigned white_level = 0;
};

TiffFields read_fields(const FileBytes& file) {
  constexpr unsigned kShort = 3;
  const std::endian order = file.has_at(0, "II") ? std::endian::little : std::endian::big;
  const std::size_t directory = file.integer<std::uint32_t>(4, order);
  const int entries = file.integer<std::uint16_t>(directory, order);
  TiffFields fields;
  for (int i = 0; i < entries; ++i) {
    const std::size_t entry = directory + 2 + 12 * static_cast<std::size_t>(i);
    const unsigned tag = file.integer<std::uint16_t>(entry, order);
    unsigned* const field = tag == 258     ? &fields.bits_per_sample
                            : tag == 281   ? &fields.max_sample_value
                            : tag == 50717 ? &fields.white_level
                                           : nullptr;
    if (field == nullptr) {
      continue;
    }
    // Of several samples the first. More than four bytes are elsewhere.
    const bool is_short = file.integer<std::uint16_t>(entry + 2, order) == kShort;
    const bool is_elsewhere = file.integer<std::uint32_t>(entry + 4, order) > (is_short ? 2U : 1U);
    const std::size_t at = is_elsewhere ? file.integer<std::uint32_t>(entry + 8, order) : entry + 8;
    *field =
        is_short ? file.integer<std::uint16_t>(at, order) : file.integer<std::uint32_t>(at, order);
  }
  return fields;
}

}  // namespace

std::optional<double> tiff_white_level(const FileBytes& file, const Photograph& photograph) try {
  if (!has_16_bits(photograph)) {
    return std::nullopt;
  }
  const TiffFields fields = read_fields(file);
  if (fields.bits_per_sample > 8 && fields.bits_per_sample < 16) {
    return kWhite;
  }
  const unsigned largest = largest_value(photograph);
  const auto can_be = [&](unsigned white) {
    return white >= std::max(1U, largest) && white < kWhite;
  };
  if (can_be(fields.white_level)) {
    return fields.white_level;
  }
  return can_be(fields.max_sample_value) ? std::optional(largest_of_bits(fields.max_sample_value))
                                         : std::nullopt;
} catch (const Error&) {
  return std::nullopt;
}

std::optional<double> png_white_level(const FileBytes& file, const Photograph& photograph) try {
  std::optional<double> stated;
  for (std::size_t offset = 8;
       has_16_bits(photograph) && !stated && !file.has_at(offset + 4, "IDAT");) {
    const std::size_t length = file.integer<std::uint32_t>(offset, std::endian::big);
    if (file.has_at(offset + 4, "sBIT") && length > 0) {
      const auto chunk = file.part(offset + 8, std::min<std::size_t>(length, 3));
      const unsigned bits = *std::max_element(chunk.begin(), chunk.end());
      if (bits >= 1 && bits < 16) {
        const double white = (1U << bits) - 1.0;
        stated = largest_value(photograph) <= white ? white : kWhite;
      }
    } else if (file.has_at(offset + 4, "eXIf")) {
      stated = tiff_white_level(FileBytes(file.part(offset + 8, length), file.name()), photograph);
    }
    offset += length + 12;
  }
  return stated;
} catch (const Error&) {
  return std::nullopt;
}

}  // namespace vantage
