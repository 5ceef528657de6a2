#include "engine/io/images/pfm.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "engine/io/files/text_header.h"

namespace vantage {

static_assert(std::endian::native == std::endian::little);

Image<float> decode_pfm(const FileBytes& file) {
  if (!file.has_at(0, "Pf") && !file.has_at(0, "PF")) {
    file.fail("is not a PFM file, expected it to begin with Pf or PF");
  }
  const int channels = file.has_at(0, "PF") ? 3 : 1;
  TextHeader header(file, 2, TextHeader::Comments::kNone);
  const int width = header.number("width");
  const int height = header.number("height");
  file.check_dimensions(width, height);
  const std::string scale_text = header.word();
  char* scale_end = nullptr;
  const double scale = std::strtod(scale_text.c_str(), &scale_end);
  if (*scale_end != '\0' || !std::isfinite(scale) || scale == 0) {
    file.fail("its scale is not a number other than 0 (negative means little-endian)");
  }

  const std::size_t row_values = static_cast<std::size_t>(width) * channels;
  const std::size_t row_bytes = row_values * sizeof(float);
  const std::size_t payload = row_bytes * static_cast<std::size_t>(height);
  // Some writers add blanks or a carriage return after the scale: the data starts after the line
  // end, or after the first blank if there is no line end among the blanks.
  std::size_t begin = header.offset();
  if (!is_blank(file.byte(begin))) {
    file.fail("its header does not end with a line break");
  }
  while (file.byte(begin) != '\n' && begin + 1 < file.size() && is_blank(file.byte(begin + 1)) &&
         file.size() - (begin + 1) > payload) {
    ++begin;
  }
  ++begin;
  if (file.size() - begin < payload) {
    file.fail(fmt::format("is truncated, {}x{} pixels take {} bytes but {} follow the header",
                          width, height, payload, file.size() - begin));
  }

  Image<float> image(width, height, channels);
  for (int y = 0; y < height; ++y) {
    const auto source =
        file.part(begin + row_bytes * static_cast<std::size_t>(height - 1 - y), row_bytes);
    std::memcpy(image.row(y), source.data(), row_bytes);
    if (scale > 0) {
      float* row = image.row(y);
      for (std::size_t i = 0; i < row_values; ++i) {
        row[i] = std::bit_cast<float>(__builtin_bswap32(std::bit_cast<std::uint32_t>(row[i])));
      }
    }
  }
  return image;
}

void encode_pfm(ImageView<const float> image, std::vector<std::uint8_t>& bytes,
                std::optional<float> unknown) {
  const std::string header = fmt::format("{}\n{} {}\n-1.0\n", image.channels() == 3 ? "PF" : "Pf",
                                         image.width(), image.height());
  const std::size_t row_values =
      static_cast<std::size_t>(image.width()) * static_cast<std::size_t>(image.channels());
  bytes.clear();
  bytes.reserve(header.size() +
                row_values * sizeof(float) * static_cast<std::size_t>(image.height()));
  bytes.insert(bytes.end(), header.begin(), header.end());
  std::vector<float> replaced(unknown ? row_values : 0);
  for (int y = image.height() - 1; y >= 0; --y) {
    const float* row = image.row(y);
    if (unknown) {
      std::transform(row, row + row_values, replaced.begin(), [value = *unknown](float stored) {
        return std::abs(stored) <= std::numeric_limits<float>::max() ? stored : value;
      });
      row = replaced.data();
    }
    const auto* row_bytes = reinterpret_cast<const std::uint8_t*>(row);
    bytes.insert(bytes.end(), row_bytes, row_bytes + row_values * sizeof(float));
  }
}

}  // namespace vantage
