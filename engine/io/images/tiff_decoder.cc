#include "engine/io/images/tiff_decoder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <functional>
#include <limits>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <string>
#include <vector>

#include "engine/io/files/text_lines.h"
#include "engine/io/images/tiff_file.h"

namespace vantage {
namespace {

constexpr int kMaxSamples = 64;
constexpr std::uint32_t kGdalNoData = 42113;
/// Of a tile that is larger than the image.
constexpr std::size_t kMaxSpareTileBytes = std::size_t{1} << 26;

/// How a page stores its pixels.
struct TiffLayout {
  int width = 0;
  int height = 0;
  int samples = 1;
  int bits = 8;
  int format = SAMPLEFORMAT_UINT;
  int photometric = PHOTOMETRIC_MINISBLACK;
  bool is_planar = false;
  bool is_tiled = false;
  bool has_alpha = false;

  [[nodiscard]] int colours() const {
    const bool is_colour = photometric == PHOTOMETRIC_RGB || photometric == PHOTOMETRIC_LOGLUV;
    return samples == 3 || (samples > 3 && is_colour) ? 3 : 1;
  }
  /// Numbers that libtiff gives as they are stored; the others it converts to 8-bit RGB.
  [[nodiscard]] bool is_plain() const {
    constexpr int kConverted[] = {PHOTOMETRIC_PALETTE, PHOTOMETRIC_SEPARATED, PHOTOMETRIC_YCBCR,
                                  PHOTOMETRIC_CIELAB,  PHOTOMETRIC_ICCLAB,    PHOTOMETRIC_ITULAB};
    return bits >= 8 && std::ranges::find(kConverted, photometric) == std::end(kConverted);
  }
  [[nodiscard]] bool has_8_bits() const { return format == SAMPLEFORMAT_UINT && bits == 8; }
  [[nodiscard]] bool has_16_bits() const {
    return format == SAMPLEFORMAT_UINT && bits > 8 && bits <= 16;
  }
};

/// Bytes of pixels that a byte of data can stand for.
long long max_expansion(int compression, long long pixel_bytes) {
  switch (compression) {
    case COMPRESSION_NONE:
      return 1;
    case COMPRESSION_LZW:  // codes of 12 bits for strings of at most 3838 bytes
      return 2559;
    case COMPRESSION_JPEG:
      return kMaxJpegPixelsPerByte * pixel_bytes;
    case COMPRESSION_ADOBE_DEFLATE:
    case COMPRESSION_DEFLATE:
      return 1032;
    case COMPRESSION_PACKBITS:  // two bytes for a run of at most 128
      return 64;
    default:  // far beyond what photographs reach
      return pixel_bytes << 19;
  }
}

TiffLayout layout_of(const FileBytes& file, const TiffFile& tiff) {
  TiffLayout layout;
  const auto small = [&](std::uint32_t tag, int otherwise) {
    return static_cast<int>(tiff.number<std::uint16_t>(tag, static_cast<std::uint16_t>(otherwise)));
  };
  const long long width = tiff.number<std::uint32_t>(TIFFTAG_IMAGEWIDTH, 0);
  const long long height = tiff.number<std::uint32_t>(TIFFTAG_IMAGELENGTH, 0);
  file.check_dimensions(width, height);
  layout.width = static_cast<int>(width);
  layout.height = static_cast<int>(height);
  layout.samples = small(TIFFTAG_SAMPLESPERPIXEL, 1);
  layout.bits = small(TIFFTAG_BITSPERSAMPLE, 1);
  if (layout.bits > 64 || layout.samples < 1 || layout.samples > kMaxSamples) {
    file.fail(fmt::format("has {} samples of {} bits per pixel, expected at most {} of 64",
                          layout.samples, layout.bits, kMaxSamples));
  }
  layout.format = small(TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_UINT);
  layout.format = layout.format == SAMPLEFORMAT_VOID ? SAMPLEFORMAT_UINT : layout.format;
  layout.photometric = small(TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
  layout.is_planar = layout.samples > 1 &&
                     small(TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG) == PLANARCONFIG_SEPARATE;
  layout.is_tiled = libtiff().TIFFIsTiled(tiff.get()) != 0;
  if (layout.photometric == PHOTOMETRIC_LOGLUV) {
    libtiff().TIFFSetField(tiff.get(), TIFFTAG_SGILOGDATAFMT, SGILOGDATAFMT_FLOAT);
    layout.format = SAMPLEFORMAT_IEEEFP;
    layout.bits = 32;
  }
  std::uint16_t extra_samples = 0;
  const std::uint16_t* kinds = nullptr;
  libtiff().TIFFGetFieldDefaulted(tiff.get(), TIFFTAG_EXTRASAMPLES, &extra_samples, &kinds);
  const bool is_alpha = extra_samples > 0 &&
                        (kinds[0] == EXTRASAMPLE_ASSOCALPHA || kinds[0] == EXTRASAMPLE_UNASSALPHA);
  // Many programs, OpenCV among them, do not say what the fourth of four is.
  layout.has_alpha = layout.samples > layout.colours() &&
                     (is_alpha || (layout.photometric == PHOTOMETRIC_RGB && layout.samples == 4));
  const bool is_subsampled = layout.photometric == PHOTOMETRIC_YCBCR;
  const long long pixel_bits = is_subsampled ? layout.bits : 1LL * layout.bits * layout.samples;
  const int compression = small(TIFFTAG_COMPRESSION, COMPRESSION_NONE);
  check_holds_pixels(
      file, width, height,
      width * height * pixel_bits / 8 / max_expansion(compression, (pixel_bits + 7) / 8));
  return layout;
}

/// What becomes of the samples of a pixel: the channels of the photograph, or their mean.
struct BandChoice {
  int channels = 1;
  std::vector<int> channel_of;  ///< of each sample; −1: not read
  bool is_mean = false;         ///< of all samples whose channel is 0
  std::string remark;
};

BandChoice choose_bands(const FileBytes& file, const TiffLayout& layout, std::optional<int> band) {
  BandChoice choice;
  const int samples = layout.samples;
  const int colours = layout.colours();
  const int bands = samples - (layout.has_alpha ? 1 : 0);
  choice.channel_of.assign(static_cast<std::size_t>(samples), -1);
  const auto take = [&](int sample, int channel) {
    choice.channel_of[static_cast<std::size_t>(sample)] = channel;
  };
  if (band) {
    if (*band < 1 || *band > samples) {
      file.fail(fmt::format("has {} bands, expected number {} (`band`) to be one of them", samples,
                            *band));
    }
    take(*band - 1, 0);
  } else if (colours == 1 && bands > 1) {
    std::fill_n(choice.channel_of.begin(), samples, 0);
    if (layout.has_alpha) {
      take(1, -1);
    }
    choice.is_mean = true;
    choice.remark = fmt::format("the mean of {} bands is read (`band` takes one of them)", bands);
  } else {
    for (int c = 0; c < colours; ++c) {
      take(c, c);
    }
    const bool reads_alpha = layout.has_alpha && colours == 3;
    if (reads_alpha) {
      take(3, 3);
    }
    choice.channels = colours + (reads_alpha ? 1 : 0);
    if (bands > colours) {
      choice.remark = fmt::format(
          "bands 1 to 3 of {} are read as red, green and blue (`band` takes one of them)", bands);
    }
  }
  return choice;
}

template <typename Stored, typename T>
void copy_values(const std::uint8_t* source, std::size_t count, T* target) {
  for (std::size_t i = 0; i < count; ++i) {
    Stored value;
    std::memcpy(&value, source + i * sizeof(Stored), sizeof(Stored));
    target[i] = static_cast<T>(value);
  }
}

/// 9 to 15 bits, highest first, scaled to 16.
void unpack_bits(const std::uint8_t* source, std::size_t count, int bits, std::uint16_t* target) {
  const unsigned largest = (1U << static_cast<unsigned>(bits)) - 1;
  std::uint32_t held = 0;
  int held_bits = 0;
  for (std::size_t i = 0; i < count; ++i) {
    while (held_bits < bits) {
      held = held << 8U | *source++;
      held_bits += 8;
    }
    held_bits -= bits;
    const unsigned value = held >> static_cast<unsigned>(held_bits) & largest;
    target[i] = static_cast<std::uint16_t>((value * 65535U + largest / 2) / largest);
  }
}

/// What reads a row of samples as T; empty: there are no such samples.
template <typename T>
std::function<void(const std::uint8_t*, std::size_t, T*)> unpack_as(const TiffLayout& layout) {
  if constexpr (sizeof(T) == 1) {
    return copy_values<std::uint8_t, T>;
  } else if constexpr (sizeof(T) == 2) {
    if (layout.bits == 16) {
      return copy_values<std::uint16_t, T>;
    }
    return [bits = layout.bits](const std::uint8_t* source, std::size_t count, T* target) {
      unpack_bits(source, count, bits, target);
    };
  } else {
    switch (layout.format * 100 + layout.bits) {
      case SAMPLEFORMAT_UINT * 100 + 32:
        return copy_values<std::uint32_t, T>;
      case SAMPLEFORMAT_UINT * 100 + 64:
        return copy_values<std::uint64_t, T>;
      case SAMPLEFORMAT_INT * 100 + 8:
        return copy_values<std::int8_t, T>;
      case SAMPLEFORMAT_INT * 100 + 16:
        return copy_values<std::int16_t, T>;
      case SAMPLEFORMAT_INT * 100 + 32:
        return copy_values<std::int32_t, T>;
      case SAMPLEFORMAT_INT * 100 + 64:
        return copy_values<std::int64_t, T>;
      case SAMPLEFORMAT_IEEEFP * 100 + 16:
        return copy_values<cv::float16_t, T>;
      case SAMPLEFORMAT_IEEEFP * 100 + 32:
        return copy_values<float, T>;
      case SAMPLEFORMAT_IEEEFP * 100 + 64:
        return copy_values<double, T>;
      default:
        return {};
    }
  }
}

/// Reads the strips or tiles of a page one after another. Each calls take(x, y, plane, rows) with
/// the values of its rows, of which those within the image count.
template <typename T, typename Take>
void for_each_row_of_chunks(const FileBytes& file, const TiffFile& tiff, const TiffLayout& layout,
                            const BandChoice& choice, const Take& take) {
  const LibtiffFunctions& functions = libtiff();
  const auto limited = [](std::uint32_t value, int most) {
    return static_cast<int>(std::min(value, static_cast<std::uint32_t>(most)));
  };
  const int columns = layout.is_tiled
                          ? limited(tiff.number<std::uint32_t>(TIFFTAG_TILEWIDTH, 0), kMaxImageSide)
                          : layout.width;
  const int rows =
      layout.is_tiled ? limited(tiff.number<std::uint32_t>(TIFFTAG_TILELENGTH, 0), kMaxImageSide)
                      : limited(tiff.number<std::uint32_t>(TIFFTAG_ROWSPERSTRIP, 1), layout.height);
  const int samples = layout.is_planar ? 1 : layout.samples;
  const std::size_t row_values =
      static_cast<std::size_t>(columns) * static_cast<std::size_t>(samples);
  const std::size_t row_bytes = (row_values * static_cast<std::size_t>(layout.bits) + 7) / 8;
  const std::uint64_t expected_bytes = layout.is_tiled ? functions.TIFFTileRowSize64(tiff.get())
                                                       : functions.TIFFScanlineSize64(tiff.get());
  if (rows < 1 || columns < 1 || row_bytes != expected_bytes) {
    file.fail(
        "is damaged or of an unsupported kind, its rows have another size than its header says");
  }
  const auto unpack = unpack_as<T>(layout);
  if (!unpack) {
    file.fail(
        fmt::format("holds values of an unsupported type ({} bits), expected integers of 8 to "
                    "16, 32 or 64 bits, or floats of 16, 32 or 64",
                    layout.bits));
  }
  const std::size_t chunk_bytes = row_bytes * static_cast<std::size_t>(rows);
  const std::size_t image_bytes = row_bytes * static_cast<std::size_t>(layout.width / columns + 1) *
                                  static_cast<std::size_t>(layout.height);
  if (chunk_bytes > std::max(kMaxSpareTileBytes, 2 * image_bytes)) {
    file.fail(fmt::format("is damaged, its tiles of {}x{} pixels are too large", columns, rows));
  }
  std::vector<std::uint8_t> chunk(chunk_bytes);
  std::vector<T> values(row_values);
  for (int plane = 0; plane < (layout.is_planar ? layout.samples : 1); ++plane) {
    if (layout.is_planar && choice.channel_of[static_cast<std::size_t>(plane)] < 0) {
      continue;
    }
    for (int y = 0; y < layout.height; y += rows) {
      const int rows_here = std::min(rows, layout.height - y);
      for (int x = 0; x < layout.width; x += columns) {
        const auto at_x = static_cast<std::uint32_t>(x);
        const auto at_y = static_cast<std::uint32_t>(y);
        const auto of_plane = static_cast<std::uint16_t>(plane);
        const auto wanted = static_cast<tmsize_t>(
            row_bytes * static_cast<std::size_t>(layout.is_tiled ? rows : rows_here));
        const tmsize_t given =
            layout.is_tiled
                ? functions.TIFFReadEncodedTile(
                      tiff.get(), functions.TIFFComputeTile(tiff.get(), at_x, at_y, 0, of_plane),
                      chunk.data(), wanted)
                : functions.TIFFReadEncodedStrip(
                      tiff.get(), functions.TIFFComputeStrip(tiff.get(), at_y, of_plane),
                      chunk.data(), wanted);
        if (given != wanted) {
          tiff.fail();
        }
        for (int row = 0; row < rows_here; ++row) {
          unpack(chunk.data() + row_bytes * static_cast<std::size_t>(row), row_values,
                 values.data());
          take(x, y + row, plane, values.data(), std::min(columns, layout.width - x), samples);
        }
      }
    }
  }
}

template <typename T>
Photograph read_plain(const FileBytes& file, const TiffFile& tiff, const TiffLayout& layout,
                      const BandChoice& choice, Photograph& memory) {
  Image<T> image = take_image<T>(memory, {layout.width, layout.height, choice.channels});
  Image<float> sums;
  if (choice.is_mean) {
    sums.resize(layout.width, layout.height);
    sums.fill(0);
  }
  for_each_row_of_chunks<T>(
      file, tiff, layout, choice,
      [&](int x, int y, int plane, const T* values, int columns, int samples) {
        for (int s = 0; s < samples; ++s) {
          const int channel = choice.channel_of[static_cast<std::size_t>(plane + s)];
          if (channel < 0) {
            continue;
          }
          float* const sum = choice.is_mean ? sums.row(y) + x : nullptr;
          T* const pixel = image.row(y) + x * choice.channels + channel;
          for (int i = 0; i < columns; ++i) {
            const T value = values[i * samples + s];
            if (sum != nullptr) {
              sum[i] += static_cast<float>(value);
            } else {
              pixel[i * choice.channels] = value;
            }
          }
        }
      });
  const auto bands = static_cast<float>(std::ranges::count(choice.channel_of, 0));
  for (int y = 0; choice.is_mean && y < layout.height; ++y) {
    std::transform(sums.row(y), sums.row(y) + layout.width, image.row(y), [&](float sum) {
      return static_cast<T>(sum / bands + (std::is_same_v<T, float> ? 0.0F : 0.5F));
    });
  }
  if (layout.photometric == PHOTOMETRIC_MINISWHITE && !std::is_same_v<T, float>) {
    for (int y = 0; y < layout.height; ++y) {
      std::transform(image.row(y), image.row(y) + layout.width * choice.channels, image.row(y),
                     [](T value) { return static_cast<T>(static_cast<T>(-1) - value); });
    }
  }
  if (layout.photometric == PHOTOMETRIC_LOGLUV && choice.channels == 3) {
    const cv::Mat pixels(layout.height, layout.width, CV_MAKETYPE(cv::DataType<T>::depth, 3),
                         image.row(0), image.view().stride() * sizeof(T));
    cv::cvtColor(pixels, pixels, cv::COLOR_XYZ2RGB);
  }
  return {std::move(image)};
}

/// 8-bit grey or RGB of what libtiff converts.
Photograph read_converted(const TiffFile& tiff, const TiffLayout& layout, Photograph& memory) {
  const bool is_grey =
      layout.photometric == PHOTOMETRIC_MINISBLACK || layout.photometric == PHOTOMETRIC_MINISWHITE;
  std::vector<std::uint32_t> raster(static_cast<std::size_t>(layout.width) *
                                    static_cast<std::size_t>(layout.height));
  const int orientation = tiff.number<std::uint16_t>(TIFFTAG_ORIENTATION, ORIENTATION_TOPLEFT);
  if (libtiff().TIFFReadRGBAImageOriented(tiff.get(), static_cast<std::uint32_t>(layout.width),
                                          static_cast<std::uint32_t>(layout.height), raster.data(),
                                          orientation, 1) == 0) {
    tiff.fail();
  }
  const int channels = is_grey ? 1 : 3;
  auto image = take_image<std::uint8_t>(memory, {layout.width, layout.height, channels});
  for (int y = 0; y < layout.height; ++y) {
    const std::uint32_t* const row =
        raster.data() + static_cast<std::size_t>(layout.width) * static_cast<std::size_t>(y);
    for (int x = 0; x < layout.width; ++x) {
      for (int c = 0; c < channels; ++c) {
        image.at(x, y, c) = static_cast<std::uint8_t>(row[x] >> 8U * static_cast<unsigned>(c));
      }
    }
  }
  return {std::move(image)};
}

}  // namespace

Photograph decode_tiff(const FileBytes& file, const PhotographReading& reading, Photograph& memory,
                       StatedByFile& stated) {
  const TiffFile tiff(file, reading.page.value_or(0));
  const TiffLayout layout = layout_of(file, tiff);
  stated.orientation =
      orientation_of_tag(tiff.number<std::uint16_t>(TIFFTAG_ORIENTATION, ORIENTATION_TOPLEFT));
  const auto read = [&]() -> Photograph {
    if (!layout.is_plain()) {
      return read_converted(tiff, layout, memory);
    }
    const BandChoice choice = choose_bands(file, layout, reading.band);
    Photograph photograph =
        layout.has_8_bits()    ? read_plain<std::uint8_t>(file, tiff, layout, choice, memory)
        : layout.has_16_bits() ? read_plain<std::uint16_t>(file, tiff, layout, choice, memory)
                               : read_plain<float>(file, tiff, layout, choice, memory);
    if (!choice.remark.empty()) {
      photograph.origin.remarks.push_back({Remark::Kind::kNote, "bands", choice.remark});
    }
    return photograph;
  };
  Photograph photograph = read();
  const bool are_floats = layout.format == SAMPLEFORMAT_IEEEFP;
  stated.integer_bits = are_floats || layout.has_8_bits() || layout.has_16_bits() ? 0 : layout.bits;
  stated.no_data = finite_number(tiff.text(kGdalNoData));
  if (auto* const floats = std::get_if<Image<float>>(&photograph.pixels);
      floats != nullptr && stated.no_data) {
    const auto no_data = static_cast<float>(*stated.no_data);
    for (int y = 0; y < layout.height; ++y) {
      std::replace(floats->row(y), floats->row(y) + layout.width * floats->channels(), no_data,
                   std::numeric_limits<float>::quiet_NaN());
    }
  }
  photograph.origin.white_level =
      layout.has_16_bits() && layout.bits < 16 ? std::optional(65535.0) : tiff.white_level();
  if (!reading.page && tiff.pages() > 1) {
    photograph.origin.remarks.push_back(
        {Remark::Kind::kNote, "pages",
         fmt::format("the first of {} pages is read (FILE#1 names the next)", tiff.pages())});
  }
  return photograph;
}

}  // namespace vantage
