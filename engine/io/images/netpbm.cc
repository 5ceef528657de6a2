#include "engine/io/images/netpbm.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <type_traits>

#include "engine/error.h"

namespace vantage {
namespace {

bool is_blank(std::uint8_t character) {
  return character == ' ' || (character >= '\t' && character <= '\r');
}

/// Reads the blank-separated words of PNM and PFM headers. Does not own the bytes.
class TextHeader {
 public:
  TextHeader(const FileBytes& file, std::size_t offset) : file_(file), offset_(offset) {}

  /// The next word, at most 64 characters. Throws Error at the end of the file.
  std::string word() {
    if (!skip_blanks()) {
      file_.fail("is truncated, it ends inside its text header or data");
    }
    const auto bytes = file_.all();
    std::string result;
    while (offset_ < bytes.size() && !is_blank(bytes[offset_])) {
      result.push_back(static_cast<char>(bytes[offset_]));
      if (result.size() > 64) {
        file_.fail("its header is not text");
      }
      ++offset_;
    }
    return result;
  }
  /// The next word as a decimal number without sign, at most 999 999 999. `what`: its name in
  /// messages.
  int number(const char* what) {
    const std::string text = word();
    int value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || value < 0 ||
        value > 999'999'999) {
      file_.fail(fmt::format("its {} is not a whole number", what));
    }
    return value;
  }
  /// Position directly after the last word: that of a blank, or the end of the file.
  [[nodiscard]] std::size_t offset() const { return offset_; }
  /// Skips the blanks and comments before the next word; false at the end of the file.
  bool skip_blanks() {
    const auto bytes = file_.all();
    bool in_comment = false;
    while (offset_ < bytes.size()) {
      const std::uint8_t c = bytes[offset_];
      if (in_comment) {
        in_comment = c != '\n' && c != '\r';
      } else if (c == '#') {
        in_comment = true;
      } else if (!is_blank(c)) {
        return true;
      }
      ++offset_;
    }
    return false;
  }

 private:
  const FileBytes& file_;
  std::size_t offset_;
};

struct PnmHeader {
  int kind = 0;  ///< 1..6, the digit after the P
  int width = 0;
  int height = 0;
  int channels = 1;
  int max_value = 255;

  [[nodiscard]] bool is_text() const { return kind <= 3; }
  [[nodiscard]] bool is_bitmap() const { return kind == 1 || kind == 4; }
  [[nodiscard]] std::size_t values_per_row() const {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(channels);
  }
};

void check_value(const FileBytes& file, const PnmHeader& header, int value, int x, int y) {
  if (value > header.max_value) {
    file.fail(fmt::format("its value {} at pixel ({}, {}) is above the maximum {} of its header",
                          value, x, y, header.max_value));
  }
}

template <typename T>
Image<T> decode_text(const FileBytes& file, const PnmHeader& header, TextHeader& words) {
  Image<T> image(header.width, header.height, header.channels);
  for (int y = 0; y < header.height; ++y) {
    for (std::size_t i = 0; i < header.values_per_row(); ++i) {
      const int value = words.number("data");
      check_value(file, header, value, static_cast<int>(i) / header.channels, y);
      image.row(y)[i] = static_cast<T>(value);
    }
  }
  return image;
}

/// Text bitmaps need no blanks between their digits.
Image<std::uint8_t> decode_text_bitmap(const FileBytes& file, const PnmHeader& header,
                                       std::size_t offset) {
  Image<std::uint8_t> image(header.width, header.height);
  for (int y = 0; y < header.height; ++y) {
    for (int x = 0; x < header.width; ++x) {
      TextHeader blanks(file, offset);
      blanks.skip_blanks();
      const std::uint8_t digit = file.byte(blanks.offset());
      if (digit != '0' && digit != '1') {
        file.fail(fmt::format("its data at pixel ({}, {}) is neither 0 nor 1", x, y));
      }
      image.at(x, y) = digit == '0' ? 255 : 0;
      offset = blanks.offset() + 1;
    }
  }
  return image;
}

Image<std::uint8_t> decode_binary_bitmap(const FileBytes& file, const PnmHeader& header,
                                         std::size_t begin) {
  const std::size_t row_bytes = (static_cast<std::size_t>(header.width) + 7) / 8;
  (void)file.part(begin, row_bytes * static_cast<std::size_t>(header.height));
  Image<std::uint8_t> image(header.width, header.height);
  for (int y = 0; y < header.height; ++y) {
    const auto row = file.part(begin + row_bytes * static_cast<std::size_t>(y), row_bytes);
    for (int x = 0; x < header.width; ++x) {
      image.at(x, y) = (row[static_cast<std::size_t>(x) / 8] >> (7 - x % 8) & 1) != 0 ? 0 : 255;
    }
  }
  return image;
}

template <typename T>
Image<T> decode_binary(const FileBytes& file, const PnmHeader& header, std::size_t begin) {
  const std::size_t row_bytes = header.values_per_row() * sizeof(T);
  (void)file.part(begin, row_bytes * static_cast<std::size_t>(header.height));
  Image<T> image(header.width, header.height, header.channels);
  for (int y = 0; y < header.height; ++y) {
    const auto row = file.part(begin + row_bytes * static_cast<std::size_t>(y), row_bytes);
    for (std::size_t i = 0; i < header.values_per_row(); ++i) {
      int value = row[i * sizeof(T)];
      if constexpr (sizeof(T) == 2) {
        value = value << 8 | row[i * 2 + 1];
      }
      check_value(file, header, value, static_cast<int>(i) / header.channels, y);
      image.row(y)[i] = static_cast<T>(value);
    }
  }
  return image;
}

}  // namespace

PnmImage decode_pnm(const FileBytes& file) {
  PnmHeader header;
  header.kind = file.byte(1) - '0';
  if (file.byte(0) != 'P' || header.kind < 1 || header.kind > 6) {
    file.fail("is not a PNM file, expected it to begin with P1 to P6");
  }
  header.channels = header.kind == 3 || header.kind == 6 ? 3 : 1;
  TextHeader words(file, 2);
  header.width = words.number("width");
  header.height = words.number("height");
  file.check_dimensions(header.width, header.height);
  if (!header.is_bitmap()) {
    header.max_value = words.number("largest value");
    if (header.max_value < 1 || header.max_value > 65535) {
      file.fail(fmt::format("its largest value is {}, expected 1..65535", header.max_value));
    }
  }
  const std::size_t begin = words.offset() + 1;
  if (header.is_text()) {
    // At least one digit each, so that a short file is refused before allocation.
    (void)file.part(begin, header.values_per_row() * static_cast<std::size_t>(header.height));
  }

  PnmImage result;
  result.max_value = header.max_value;
  auto& pixels = result.photograph.pixels;
  if (header.kind == 1) {
    pixels = decode_text_bitmap(file, header, begin);
  } else if (header.kind == 4) {
    pixels = decode_binary_bitmap(file, header, begin);
  } else if (header.max_value > 255) {
    pixels = header.is_text() ? decode_text<std::uint16_t>(file, header, words)
                              : decode_binary<std::uint16_t>(file, header, begin);
  } else {
    pixels = header.is_text() ? decode_text<std::uint8_t>(file, header, words)
                              : decode_binary<std::uint8_t>(file, header, begin);
  }
  return result;
}

std::vector<std::uint8_t> encode_pnm(const Photograph& photograph) {
  const bool wide = std::holds_alternative<Image<std::uint16_t>>(photograph.pixels);
  const std::string header =
      fmt::format("{}\n{} {}\n{}\n", photograph.channels() == 3 ? "P6" : "P5", photograph.width(),
                  photograph.height(), wide ? 65535 : 255);
  std::vector<std::uint8_t> bytes(header.begin(), header.end());
  std::visit(
      [&]<typename T>(const Image<T>& image) {
        if constexpr (std::is_integral_v<T>) {
          const int values = image.width() * image.channels();
          bytes.reserve(bytes.size() + sizeof(T) * static_cast<std::size_t>(values) *
                                           static_cast<std::size_t>(image.height()));
          for (int y = 0; y < image.height(); ++y) {
            for (int i = 0; i < values; ++i) {
              if constexpr (sizeof(T) == 2) {
                bytes.push_back(static_cast<std::uint8_t>(image.row(y)[i] >> 8));
              }
              bytes.push_back(static_cast<std::uint8_t>(image.row(y)[i] & 255));
            }
          }
        } else {
          throw Error("PNM holds 8- and 16-bit values only");
        }
      },
      photograph.pixels);
  return bytes;
}

static_assert(std::endian::native == std::endian::little);

Image<float> decode_pfm(const FileBytes& file) {
  if (!file.has_at(0, "Pf") && !file.has_at(0, "PF")) {
    file.fail("is not a PFM file, expected it to begin with Pf or PF");
  }
  const int channels = file.has_at(0, "PF") ? 3 : 1;
  TextHeader header(file, 2);
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
