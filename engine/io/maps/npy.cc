#include "engine/io/maps/npy.h"
#include "engine/quoted_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

namespace vantage {
namespace {

static_assert(std::endian::native == std::endian::little);

constexpr std::string_view kMagic = "\x93NUMPY";

/// A header is a Python dictionary of three entries; longer text is not one.
constexpr std::size_t kMaxHeaderBytes = 4096;

/// The text after `'key':` in a Python dictionary of plain values, blanks skipped.
std::string_view find_value(const FileBytes& file, std::string_view dictionary,
                            std::string_view key) {
  for (const char quote : {'\'', '"'}) {
    const std::string quoted = quote + std::string(key) + quote;
    std::size_t position = dictionary.find(quoted);
    if (position == std::string_view::npos) {
      continue;
    }
    position = dictionary.find_first_not_of(' ', position + quoted.size());
    if (position == std::string_view::npos || dictionary[position] != ':') {
      continue;
    }
    position = dictionary.find_first_not_of(' ', position + 1);
    if (position != std::string_view::npos) {
      return dictionary.substr(position);
    }
  }
  file.fail(fmt::format("its NPY header has no usable '{}' entry", key));
}

/// The text between the first character of `value` and the next `end`.
std::string_view enclosed(const FileBytes& file, std::string_view value, char end) {
  const std::size_t length = value.find(end, 1);
  if (length == std::string_view::npos) {
    file.fail("its NPY header is not a Python dictionary");
  }
  return value.substr(1, length - 1);
}

struct Shape {
  int height = 0;
  int width = 0;
};

/// Parses "480, 640" (a comma may follow).
std::optional<Shape> parse_shape(std::string_view text) {
  Shape shape;
  const auto take = [&](int& number) {
    text.remove_prefix(std::min(text.find_first_not_of(' '), text.size()));
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || number < 0) {
      return false;
    }
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    text.remove_prefix(std::min(text.find_first_not_of(' '), text.size()));
    return true;
  };
  if (!take(shape.height) || !text.starts_with(',')) {
    return std::nullopt;
  }
  text.remove_prefix(1);
  if (!take(shape.width)) {
    return std::nullopt;
  }
  const bool complete = text.empty() || text.find_first_not_of(' ', 1) == std::string_view::npos;
  return complete && (text.empty() || text[0] == ',') ? std::optional(shape) : std::nullopt;
}

template <typename Stored>
void copy_rows(const FileBytes& file, std::size_t begin, Image<float>& image) {
  const std::size_t row_bytes = sizeof(Stored) * static_cast<std::size_t>(image.width());
  for (int y = 0; y < image.height(); ++y) {
    const auto source = file.part(begin + row_bytes * static_cast<std::size_t>(y), row_bytes);
    for (int x = 0; x < image.width(); ++x) {
      Stored value;
      std::memcpy(&value, source.data() + sizeof(Stored) * static_cast<std::size_t>(x),
                  sizeof(Stored));
      image.at(x, y) = static_cast<float>(value);
    }
  }
}

}  // namespace

bool is_npy(const FileBytes& file) { return file.has_at(0, kMagic); }

Image<float> decode_npy(const FileBytes& file) {
  if (!is_npy(file)) {
    file.fail("is not a NumPy array file");
  }
  const int version = file.byte(6);
  if (version < 1 || version > 3) {
    file.fail(fmt::format("is of NPY version {}, expected 1, 2 or 3", version));
  }
  const std::size_t header_begin = version == 1 ? 10 : 12;
  const std::size_t header_bytes = version == 1
                                       ? file.integer<std::uint16_t>(8, std::endian::little)
                                       : file.integer<std::uint32_t>(8, std::endian::little);
  if (header_bytes > kMaxHeaderBytes) {
    file.fail(fmt::format("its NPY header of {} bytes is longer than that of a plain array",
                          header_bytes));
  }
  const auto header = file.part(header_begin, header_bytes);
  const std::string dictionary(header.begin(), header.end());

  const std::string_view type_value = find_value(file, dictionary, "descr");
  const bool is_plain_type = type_value[0] == '\'' || type_value[0] == '"';
  const std::string_view type =
      is_plain_type ? enclosed(file, type_value, type_value[0]) : "record";
  if (type != "<f4" && type != "<f8") {
    file.fail(fmt::format("holds values of type {}, expected <f4 or <f8", quotable(type)));
  }
  if (!find_value(file, dictionary, "fortran_order").starts_with("False")) {
    file.fail("is in Fortran order, expected C order");
  }
  const std::string_view shape_text = enclosed(file, find_value(file, dictionary, "shape"), ')');
  const std::optional<Shape> shape = parse_shape(shape_text);
  if (!shape) {
    file.fail(fmt::format("has shape ({}), expected (height, width)", quotable(shape_text)));
  }
  const int height = shape->height;
  const int width = shape->width;
  file.check_dimensions(width, height);

  const std::size_t begin = header_begin + header_bytes;
  const std::size_t payload = (type == "<f4" ? 4U : 8U) * static_cast<std::size_t>(width) *
                              static_cast<std::size_t>(height);
  if (file.size() - begin < payload) {
    file.fail(fmt::format("is truncated, {}x{} values take {} bytes but {} follow the header",
                          width, height, payload, file.size() - begin));
  }
  Image<float> image(width, height);
  if (type == "<f4") {
    copy_rows<float>(file, begin, image);
  } else {
    copy_rows<double>(file, begin, image);
  }
  return image;
}

namespace {

/// Everything before the values; `shape` is a Python tuple without the parentheses.
std::vector<std::uint8_t> npy_header(std::string_view type, std::string_view shape) {
  std::string header =
      fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': ({}), }}", type, shape);
  // The data starts at a multiple of 64 bytes: magic, version and length are ten bytes.
  header.append(63 - (10 + header.size()) % 64, ' ');
  header.push_back('\n');
  std::vector<std::uint8_t> bytes(kMagic.begin(), kMagic.end());
  for (const std::size_t byte :
       {std::size_t{1}, std::size_t{0}, header.size() & 255U, header.size() >> 8}) {
    bytes.push_back(static_cast<std::uint8_t>(byte));
  }
  bytes.insert(bytes.end(), header.begin(), header.end());
  return bytes;
}

std::string tuple_of(std::span<const int> shape) {
  std::string sides;
  for (const int side : shape) {
    sides += fmt::format("{},", side);
  }
  return sides;
}

}  // namespace

std::vector<std::uint8_t> encode_npy(ImageView<const float> image) {
  const std::string channels = image.channels() == 1 ? "" : fmt::format(", {}", image.channels());
  std::vector<std::uint8_t> bytes =
      npy_header("<f4", fmt::format("{}, {}{}", image.height(), image.width(), channels));
  const std::size_t row_bytes =
      sizeof(float) * static_cast<std::size_t>(image.width()) * image.channels();
  bytes.reserve(bytes.size() + row_bytes * static_cast<std::size_t>(image.height()));
  for (int y = 0; y < image.height(); ++y) {
    const auto* row = reinterpret_cast<const std::uint8_t*>(image.row(y));
    bytes.insert(bytes.end(), row, row + row_bytes);
  }
  return bytes;
}

std::vector<std::uint8_t> npy_float_header(std::span<const int> shape) {
  return npy_header("<f4", tuple_of(shape));
}

std::vector<std::uint8_t> encode_npy(std::span<const double> values, std::span<const int> shape) {
  std::vector<std::uint8_t> bytes = npy_header("<f8", tuple_of(shape));
  const auto* begin = reinterpret_cast<const std::uint8_t*>(values.data());
  bytes.insert(bytes.end(), begin, begin + values.size_bytes());
  return bytes;
}

}  // namespace vantage
