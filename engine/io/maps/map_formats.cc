#include "engine/io/maps/map_formats.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstring>
#include <iterator>
#include <limits>
#include <utility>

#include "engine/error.h"
#include "engine/image/finite_values.h"
#include "engine/io/images/netpbm.h"
#include "engine/io/images/photograph_io.h"
#include "engine/io/images/png_encoder.h"
#include "engine/io/maps/npy.h"
#include "kernels/integer_disparity/integer_disparity.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;
using Bytes = std::vector<std::uint8_t>;
using Disparity = ImageView<const float>;

static_assert(std::endian::native == std::endian::little);

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

void disparity_as_pfm(const fs::path& /*path*/, Disparity disparity, Bytes& bytes,
                      Execution* /*execution*/) {
  encode_pfm(disparity, bytes, std::numeric_limits<float>::infinity());
}

void disparity_as_npy(const fs::path& /*path*/, Disparity disparity, Bytes& bytes,
                      Execution* /*execution*/) {
  bytes = encode_npy(with_nan(disparity).view());
}

void disparity_as_floats(const fs::path& path, Disparity disparity, Bytes& bytes,
                         Execution* /*execution*/) {
  encode_photograph(path, Photograph{with_nan(disparity)}, bytes);
}

/// A map as 16-bit PNG, made row by row: convert(values, count, stored) returns the first column
/// whose value does not fit. For that of the first row, calls refuse(x, y).
template <typename Convert, typename Refuse>
void map_as_png(const fs::path& path, ImageView<const float> map, const Convert& convert,
                const Refuse& refuse, Bytes& bytes, Execution* execution) {
  std::atomic<bool> fits = true;
  const auto row = [&](int y, std::uint16_t* memory) {
    if (convert(map.row(y), map.width(), memory) < map.width()) {
      fits = false;
    }
    return memory;
  };
  encode_png(map.width(), map.height(), row, bytes, execution);
  std::vector<std::uint16_t> memory(static_cast<std::size_t>(map.width()));
  for (int y = 0; !fits && y < map.height(); ++y) {
    const int x = convert(map.row(y), map.width(), memory.data());
    if (x < map.width()) {
      refuse(x, y);
    }
  }
  if (bytes.empty()) {
    throw Error(fmt::format("cannot write {}: an image of {}x{} pixels does not fit a .png file",
                            path.string(), map.width(), map.height()));
  }
}

void disparity_as_png(const fs::path& path, Disparity disparity, Bytes& bytes,
                      Execution* execution) {
  static_assert(kernels::kIntegerUnitsPerPx == kIntegerDisparityScale);
  const auto refuse = [&](int x, int y) {
    throw Error(fmt::format(
        "cannot write {}: disparity {} at pixel ({}, {}) does not fit a 16-bit PNG, expected "
        "0..255.99, or a file in {}, which have no limits",
        path.string(), disparity.at(x, y), x, y, listed_map_formats(MapContent::kConfidence)));
  };
  map_as_png(path, disparity, kernels::integer_disparity_row, refuse, bytes, execution);
}

/// As kernels::integer_disparity_row().
int millimetre_row(const float* depth_m, int width, std::uint16_t* stored) {
  for (int x = 0; x < width; ++x) {
    const double depth = static_cast<double>(depth_m[x]);
    const double millimetres = std::max(std::round(depth * kIntegerDepthScale), 1.0);
    if (std::isfinite(depth) && millimetres > 65535) {
      return x;
    }
    stored[x] = static_cast<std::uint16_t>(std::isfinite(depth) ? millimetres : 0);
  }
  return width;
}

void depth_as_png(const fs::path& path, ImageView<const float> depth_m, Bytes& bytes,
                  Execution* execution) {
  const auto refuse = [&](int x, int y) {
    throw Error(
        fmt::format("cannot write {}: depth {} m at pixel ({}, {}) does not fit a 16-bit PNG of "
                    "millimetres, expected at most {}, or a file in {}",
                    path.string(), depth_m.at(x, y), x, y, kMaxIntegerDepth_m,
                    listed_map_formats(MapContent::kConfidence)));
  };
  map_as_png(path, depth_m, millimetre_row, refuse, bytes, execution);
}

/// (u, v) interleaved; both `unknown` where one of them is not finite.
Image<float> interleaved(const DisplacementView& displacements, Side side, float unknown) {
  const float sign = side == Side::kLeft ? -1.0F : 1.0F;
  const int width = displacements.x_px.width();
  Image<float> result(width, displacements.x_px.height(), 2);
  for (int y = 0; y < result.height(); ++y) {
    const float* along_x = displacements.x_px.row(y);
    const float* along_y = displacements.y_px.row(y);
    float* target = result.row(y);
    for (int x = 0; x < width; ++x) {
      const bool known = std::isfinite(along_x[x]) && std::isfinite(along_y[x]);
      // Adding zero turns −0 into 0 for disparity 0.
      target[2 * x] = known ? sign * along_x[x] + 0.0F : unknown;
      target[2 * x + 1] = known ? sign * along_y[x] + 0.0F : unknown;
    }
  }
  return result;
}

void displacements_as_flo(const fs::path& /*path*/, const DisplacementView& displacements,
                          Side side, Bytes& bytes) {
  constexpr float kFloUnknown = 1e10F;
  constexpr std::size_t kHeaderBytes = 12;
  const Image<float> values = interleaved(displacements, side, kFloUnknown);
  const std::size_t row_bytes = 2 * sizeof(float) * static_cast<std::size_t>(values.width());
  bytes.resize(kHeaderBytes + row_bytes * static_cast<std::size_t>(values.height()));
  const std::int32_t size[2] = {values.width(), values.height()};
  std::memcpy(bytes.data(), "PIEH", 4);
  std::memcpy(bytes.data() + 4, size, sizeof size);
  for (int y = 0; y < values.height(); ++y) {
    std::memcpy(bytes.data() + kHeaderBytes + row_bytes * static_cast<std::size_t>(y),
                values.row(y), row_bytes);
  }
}

void displacements_as_npy(const fs::path& /*path*/, const DisplacementView& displacements,
                          Side side, Bytes& bytes) {
  bytes = encode_npy(interleaved(displacements, side, kNan).view());
}

/// Three channels, because image formats do not have two.
void displacements_as_floats(const fs::path& path, const DisplacementView& displacements, Side side,
                             Bytes& bytes) {
  const Image<float> values = interleaved(displacements, side, kNan);
  Image<float> result(values.width(), values.height(), 3);
  for (int y = 0; y < result.height(); ++y) {
    for (int x = 0; x < result.width(); ++x) {
      const bool known = !std::isnan(values.at(x, y, 0));
      result.at(x, y, 0) = known ? values.at(x, y, 0) : 0;
      result.at(x, y, 1) = known ? values.at(x, y, 1) : 0;
      result.at(x, y, 2) = known ? 1.0F : 0.0F;
    }
  }
  encode_photograph(path, Photograph{std::move(result)}, bytes);
}

constexpr MapFormat kFormats[] = {
    {.extension = ".flo", .encode_displacements = displacements_as_flo},
    {.extension = ".pfm", .encode_disparity = disparity_as_pfm, .encode_depth = disparity_as_pfm},
    {.extension = ".png",
     .holds_any_value = false,
     .encode_disparity = disparity_as_png,
     .encode_depth = depth_as_png},
    {.extension = ".tiff",
     .encode_disparity = disparity_as_floats,
     .encode_depth = disparity_as_floats,
     .encode_displacements = displacements_as_floats},
    {.extension = ".tif",
     .is_listed = false,
     .encode_disparity = disparity_as_floats,
     .encode_depth = disparity_as_floats,
     .encode_displacements = displacements_as_floats},
    {.extension = ".exr",
     .encode_disparity = disparity_as_floats,
     .encode_depth = disparity_as_floats,
     .encode_displacements = displacements_as_floats},
    {.extension = ".npy",
     .encode_disparity = disparity_as_npy,
     .encode_depth = disparity_as_npy,
     .encode_displacements = displacements_as_npy,
     .recognizes = is_npy,
     .decode = decode_npy},
};

}  // namespace

bool MapFormat::can_hold(MapContent content) const {
  switch (content) {
    case MapContent::kDisplacements:
      return encode_displacements != nullptr;
    case MapContent::kDepth:
      return encode_depth != nullptr;
    case MapContent::kConfidence:
      return encode_disparity != nullptr && holds_any_value;
    case MapContent::kDisparity:
      break;
  }
  return encode_disparity != nullptr;
}

std::span<const MapFormat> map_formats() { return kFormats; }

const MapFormat* find_map_format(const fs::path& path, MapContent content) {
  const std::string extension = lower_case_extension(path);
  const auto* const found = std::ranges::find_if(kFormats, [&](const MapFormat& format) {
    return format.extension == extension && format.can_hold(content);
  });
  return found == std::end(kFormats) ? nullptr : found;
}

const MapFormat* find_map_format(const FileBytes& file) {
  const auto* const found = std::ranges::find_if(kFormats, [&](const MapFormat& format) {
    return format.recognizes != nullptr && format.recognizes(file);
  });
  return found == std::end(kFormats) ? nullptr : found;
}

std::string listed_map_formats(MapContent content, std::string_view prefix) {
  std::vector<std::string> names;
  for (const MapFormat& format : kFormats) {
    if (format.is_listed && format.can_hold(content)) {
      names.push_back(fmt::format("{}{}", prefix, format.extension.substr(1)));
    }
  }
  const std::string last = names.back();
  names.pop_back();
  return fmt::format("{} or {}", fmt::join(names, ", "), last);
}

}  // namespace vantage
