#include "engine/io/maps/npy.h"
#include "engine/quoted_text.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <bit>
#include <charconv>
#include <iterator>
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

/// Parses "480, 640" (a comma may follow), without sides of 1 before or after these two.
std::optional<Shape> parse_shape(std::string_view text) {
  std::vector<int> sides;
  while (text.find_first_not_of(' ') != std::string_view::npos) {
    text.remove_prefix(text.find_first_not_of(' '));
    int side = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), side);
    if (error != std::errc() || side < 0) {
      return std::nullopt;
    }
    sides.push_back(side);
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    text.remove_prefix(std::min(text.find_first_not_of(' '), text.size()));
    if (!text.empty() && text[0] != ',') {
      return std::nullopt;
    }
    text.remove_prefix(std::min<std::size_t>(1, text.size()));
  }
  while (sides.size() > 2 && sides.back() == 1) {
    sides.pop_back();
  }
  while (sides.size() > 2 && sides.front() == 1) {
    sides.erase(sides.begin());
  }
  return sides.size() == 2 ? std::optional<Shape>({sides[0], sides[1]}) : std::nullopt;
}

/// Where the values are, and how they are stored.
struct Layout {
  std::size_t begin = 0;
  bool is_fortran = false;
};

template <typename Stored>
void copy_values(const FileBytes& file, const Layout& layout, Image<float>& image) {
  const auto width = static_cast<std::size_t>(image.width());
  const auto height = static_cast<std::size_t>(image.height());
  const auto source = file.part(layout.begin, sizeof(Stored) * width * height);
  for (std::size_t y = 0; y < height; ++y) {
    float* const row = image.row(static_cast<int>(y));
    for (std::size_t x = 0; x < width; ++x) {
      Stored value;
      const std::size_t index = layout.is_fortran ? x * height + y : y * width + x;
      std::memcpy(&value, source.data() + sizeof(Stored) * index, sizeof(Stored));
      row[x] = static_cast<float>(value);
    }
  }
}

/// A type of values by NumPy's name, without the byte order.
struct NpyType {
  std::string_view name;
  int integer_bits;
  void (*copy)(const FileBytes& file, const Layout& layout, Image<float>& image);
};
constexpr NpyType kNpyTypes[] = {
    {"f2", 0, copy_values<Eigen::half>},    {"f4", 0, copy_values<float>},
    {"f8", 0, copy_values<double>},         {"i1", 8, copy_values<std::int8_t>},
    {"u1", 8, copy_values<std::uint8_t>},   {"i2", 16, copy_values<std::int16_t>},
    {"u2", 16, copy_values<std::uint16_t>}, {"i4", 32, copy_values<std::int32_t>},
    {"u4", 32, copy_values<std::uint32_t>}, {"i8", 64, copy_values<std::int64_t>},
    {"u8", 64, copy_values<std::uint64_t>}};

}  // namespace

bool is_npy(const FileBytes& file) { return file.has_at(0, kMagic); }

StoredMap decode_npy(const FileBytes& file) {
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
  const auto* const stored = std::ranges::find_if(kNpyTypes, [&](const NpyType& known) {
    return type.size() == 3 && std::string_view("<|").find(type[0]) != std::string_view::npos &&
           type.substr(1) == known.name;
  });
  if (stored == std::end(kNpyTypes)) {
    file.fail(
        fmt::format("holds values of type {}, expected floats or integers (<f2, <f4, "
                    "<f8, |u1, <i2 ...)",
                    quotable(type)));
  }
  const std::string_view order = find_value(file, dictionary, "fortran_order");
  const std::string_view shape_text = enclosed(file, find_value(file, dictionary, "shape"), ')');
  const std::optional<Shape> shape = parse_shape(shape_text);
  if (!shape) {
    file.fail(fmt::format("has shape ({}), expected (height, width)", quotable(shape_text)));
  }
  const int height = shape->height;
  const int width = shape->width;
  file.check_dimensions(width, height);

  const Layout layout{.begin = header_begin + header_bytes,
                      .is_fortran = order.starts_with("True")};
  const std::size_t payload = static_cast<std::size_t>(type[2] - '0') *
                              static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  if (file.size() - layout.begin < payload) {
    file.fail(fmt::format("is truncated, {}x{} values take {} bytes but {} follow the header",
                          width, height, payload, file.size() - layout.begin));
  }
  StoredMap map{.values = Image<float>(width, height),
                .integer_bits = stored->integer_bits,
                .is_signed = type[1] == 'i'};
  stored->copy(file, layout, map.values);
  return map;
}

namespace {

/// Everything before the values; `shape` is a Python tuple without the parentheses.
std::vector<std::uint8_t> npy_header(std::string_view shape) {
  std::string header =
      fmt::format("{{'descr': '<f4', 'fortran_order': False, 'shape': ({}), }}", shape);
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

}  // namespace

std::vector<std::uint8_t> encode_npy(ImageView<const float> image) {
  const std::string channels = image.channels() == 1 ? "" : fmt::format(", {}", image.channels());
  std::vector<std::uint8_t> bytes =
      npy_header(fmt::format("{}, {}{}", image.height(), image.width(), channels));
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
  std::string sides;
  for (const int side : shape) {
    sides += fmt::format("{},", side);
  }
  return npy_header(sides);
}

}  // namespace vantage
