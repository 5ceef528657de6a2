#include "engine/io/images/photograph_io.h"

#include <fmt/format.h>

#include <climits>
#include <cmath>
#include <new>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>

#include "engine/error.h"
#include "engine/image/left_out.h"
#include "engine/image/orientation.h"
#include "engine/image/white_level.h"
#include "engine/io/files/atomic_file.h"
#include "engine/io/files/file_bytes.h"
#include "engine/io/files/numbered_part.h"
#include "engine/io/images/image_header.h"
#include "engine/io/images/netpbm.h"
#include "engine/io/images/opencv_setup.h"
#include "engine/io/images/png_decoder.h"
#include "engine/io/images/png_encoder.h"
#include "engine/io/images/stereo_jpeg.h"
#include "engine/io/images/tiff_decoder.h"

namespace vantage {
namespace {

/// A cv::Mat over the pixels of `image`, which it does not own.
template <typename T>
cv::Mat wrap(const Image<T>& image) {
  return {image.height(), image.width(), CV_MAKETYPE(cv::DataType<T>::depth, image.channels()),
          const_cast<T*>(image.row(0)), image.view().stride() * sizeof(T)};
}

template <typename T>
Image<T> from_bgr(const cv::Mat& decoded, Photograph& memory) {
  Image<T> image = take_image<T>(memory, {decoded.cols, decoded.rows, decoded.channels()});
  cv::Mat target = wrap(image);
  switch (decoded.channels()) {
    case 3:
      cv::cvtColor(decoded, target, cv::COLOR_BGR2RGB);
      break;
    case 4:
      cv::cvtColor(decoded, target, cv::COLOR_BGRA2RGBA);
      break;
    default:
      decoded.copyTo(target);
  }
  return image;
}

Photograph decode_with_opencv(const FileBytes& file, std::span<const std::uint8_t> bytes,
                              Photograph& memory) {
  prepare_opencv();
  if (bytes.size() > INT_MAX) {
    file.fail(
        fmt::format("has {} bytes, expected at most {} in this format", bytes.size(), INT_MAX));
  }
  cv::Mat decoded;
  try {
    const QuietOpenCv quiet;
    const cv::Mat encoded(1, static_cast<int>(bytes.size()), CV_8UC1,
                          const_cast<std::uint8_t*>(bytes.data()));
    // "Unchanged" keeps depth and channels and ignores the EXIF orientation.
    decode_by_opencv(encoded, decoded);
  } catch (const cv::Exception&) {
    decoded.release();
  }
  if (decoded.empty()) {
    file.fail("is damaged or of an unsupported kind, its pixels cannot be decoded");
  }
  file.check_dimensions(decoded.cols, decoded.rows);
  if (decoded.channels() != 1 && decoded.channels() != 3 && decoded.channels() != 4) {
    file.fail(fmt::format("has {} channels, expected 1, 3 or 4", decoded.channels()));
  }
  switch (decoded.depth()) {
    case CV_8U:
      return {from_bgr<std::uint8_t>(decoded, memory)};
    case CV_16U:
      return {from_bgr<std::uint16_t>(decoded, memory)};
    case CV_32F:
      return {from_bgr<float>(decoded, memory)};
    default:
      file.fail(
          "holds values of an unsupported type, expected unsigned 8-bit, unsigned 16-bit or float");
  }
}

/// Leaves `bytes` empty when the image does not fit the format.
void encode_with_opencv(const std::string& extension, const Photograph& photograph,
                        std::vector<std::uint8_t>& bytes) {
  prepare_opencv();
  std::visit(
      [&](const auto& image) {
        cv::Mat pixels = wrap(image);
        cv::Mat reordered;
        if (image.channels() == 3) {
          cv::cvtColor(pixels, reordered, cv::COLOR_RGB2BGR);
          pixels = reordered;
        } else if (image.channels() == 4) {
          cv::cvtColor(pixels, reordered, cv::COLOR_RGBA2BGRA);
          pixels = reordered;
        }
        // Otherwise OpenCV packs float colours as LogLuv, which is lossy.
        std::vector<int> parameters;
        if (extension == ".tif" || extension == ".tiff") {
          constexpr int kLzw = 5;
          parameters = {cv::IMWRITE_TIFF_COMPRESSION, kLzw};
        }
        if (!encode_by_opencv(extension, pixels, bytes, parameters)) {
          bytes.clear();
        }
      },
      photograph.pixels);
}

/// Leaves `bytes` empty when the image does not fit the format; floats never do.
void encode_as_png(const Photograph& photograph, std::vector<std::uint8_t>& bytes,
                   Execution* execution) {
  bytes.clear();
  std::visit(
      [&]<typename T>(const Image<T>& image) {
        if constexpr (!std::is_same_v<T, float>) {
          encode_png(image, bytes, execution);
        }
      },
      photograph.pixels);
}

/// Depths and channels that a format supports, by extension.
struct Capability {
  std::string_view extension;
  std::string_view depths;    ///< 'b' 8-bit, 'w' 16-bit, 'f' float
  std::string_view channels;  ///< digits
};
constexpr Capability kCapabilities[] = {
    {".png", "bw", "134"},   {".jpg", "b", "13"},   {".jpeg", "b", "13"}, {".tif", "bwf", "134"},
    {".tiff", "bwf", "134"}, {".bmp", "b", "13"},   {".pgm", "bw", "1"},  {".ppm", "bw", "3"},
    {".pnm", "bw", "13"},    {".webp", "b", "134"}, {".exr", "f", "134"}, {".pfm", "f", "13"}};

template <typename T>
constexpr char kDepthCode = std::is_same_v<T, float> ? 'f' : (sizeof(T) == 2 ? 'w' : 'b');

void check_capability(const std::filesystem::path& path, const std::string& extension,
                      const Photograph& photograph) {
  const Capability* found = nullptr;
  for (const Capability& capability : kCapabilities) {
    found = capability.extension == extension ? &capability : found;
  }
  if (found == nullptr) {
    throw UsageError(
        fmt::format("cannot write {}: unknown image extension '{}', expected .png .jpg .tiff .bmp "
                    ".ppm .pgm .webp .exr or .pfm",
                    path.string(), extension));
  }
  const char depth =
      std::visit([]<typename T>(const Image<T>&) { return kDepthCode<T>; }, photograph.pixels);
  if (found->depths.find(depth) == std::string_view::npos) {
    const char* name = depth == 'b' ? "8-bit" : depth == 'w' ? "16-bit" : "float";
    throw Error(fmt::format("cannot write {}: {} files cannot hold {} values", path.string(),
                            extension, name));
  }
  const char channels = static_cast<char>('0' + photograph.channels());
  if (found->channels.find(channels) == std::string_view::npos) {
    throw Error(fmt::format("cannot write {}: {} files cannot hold {} channels", path.string(),
                            extension, photograph.channels()));
  }
}

/// Makes one band of several the photograph, if it was not chosen yet.
void take_band(const FileBytes& file, std::optional<int> band, Photograph& photograph) {
  const int channels = photograph.channels();
  if (!band || (channels == 1 && *band == 1)) {
    return;
  }
  if (*band < 1 || *band > channels) {
    file.fail(fmt::format("has {} band{}, expected number {} (`band`) to be one of them", channels,
                          channels == 1 ? "" : "s", *band));
  }
  std::visit(
      [&]<typename T>(Image<T>& image) {
        Image<T> grey(image.width(), image.height());
        cv::Mat target = wrap(grey);
        cv::extractChannel(wrap(image), target, *band - 1);
        image = std::move(grey);
      },
      photograph.pixels);
}

DecodedImage decode(const FileBytes& file, const PhotographReading& reading, Photograph& memory) {
  const ImageFormat format = detect_image_format(file);
  DecodedImage result;
  StatedByFile stated;
  switch (format) {
    case ImageFormat::kPfm:
      result.photograph.pixels = decode_pfm(file);
      break;
    case ImageFormat::kPnm: {
      PnmImage pnm = decode_pnm(file);
      result.photograph = std::move(pnm.photograph);
      result.max_value = pnm.max_value;
      break;
    }
    case ImageFormat::kPng: {
      const PngStructure structure = check_png_structure(file);
      std::optional<Photograph> usual = decode_usual_png(structure, memory);
      result.photograph =
          usual ? std::move(*usual) : decode_any_png(file, strip_png(structure), memory);
      // The standard wants values scaled to 16 bits, which WhiteLevelSearch sees.
      if (const int bits = structure.significant_bits; bits > 0 && bits < structure.bit_depth) {
        result.photograph.origin.white_level = (1 << bits) - 1;
      }
      stated.orientation = structure.orientation;
      break;
    }
    case ImageFormat::kJpeg:
      result.photograph = decode_jpeg_view(file, reading, memory, stated);
      break;
    case ImageFormat::kTiff:
      result.photograph = decode_tiff(file, reading, memory, stated);
      result.integer_bits = stated.integer_bits;
      result.no_data = stated.no_data;
      break;
    default:
      stated = check_image_header(file, format);
      result.photograph = decode_with_opencv(file, file.all(), memory);
  }
  if (format != ImageFormat::kTiff || result.photograph.channels() > 1) {  // else it was chosen
    take_band(file, reading.band, result.photograph);
  }
  if (reading.turns_upright) {
    turn_upright(result.photograph, stated.orientation);
  }
  if (format != ImageFormat::kPnm &&
      std::holds_alternative<Image<std::uint16_t>>(result.photograph.pixels)) {
    result.max_value = 65535;
  }
  return result;
}

void refuse_infinity(const FileBytes& file, const Image<float>& image) {
  for (int y = 0; y < image.height(); ++y) {
    const float* row = image.row(y);
    for (int i = 0; i < image.width() * image.channels(); ++i) {
      if (std::isinf(row[i])) {
        file.fail(fmt::format("its value at pixel ({}, {}) is {}, expected finite values or NaN",
                              i / image.channels(), y, row[i]));
      }
    }
  }
}

}  // namespace

DecodedImage decode_image(const FileBytes& file, const PhotographReading& reading,
                          Photograph memory) {
  try {
    return decode(file, reading, memory);
  } catch (const OutOfMemory& error) {
    file.fail(error.what());
  } catch (const std::bad_alloc&) {
    file.fail("out of memory for its pixels");
  }
}

void encode_photograph(const std::filesystem::path& path, const Photograph& photograph,
                       std::vector<std::uint8_t>& bytes, Execution* execution) {
  if (photograph.width() < 1 || photograph.height() < 1) {
    throw Error(fmt::format("cannot write {}: the image has no pixels", path.string()));
  }
  const std::string extension = lower_case_extension(path);
  check_capability(path, extension, photograph);
  if (extension == ".pfm") {
    encode_pfm(std::get<Image<float>>(photograph.pixels).view(), bytes);
    return;
  }
  if (extension == ".pgm" || extension == ".ppm" || extension == ".pnm") {
    bytes = encode_pnm(photograph);
    return;
  }
  try {
    if (extension == ".png") {
      encode_as_png(photograph, bytes, execution);
    } else {
      encode_with_opencv(extension, photograph, bytes);
    }
  } catch (const cv::Exception&) {
    bytes.clear();
  }
  if (bytes.empty()) {
    throw Error(fmt::format("cannot write {}: an image of {}x{} pixels does not fit a {} file",
                            path.string(), photograph.width(), photograph.height(), extension));
  }
}

Photograph read_photograph(const std::filesystem::path& path, const PhotographReading& reading,
                           Photograph memory) {
  const NumberedPart part = numbered_part(path);
  const std::vector<std::uint8_t> bytes = read_file_bytes(part.file);
  const FileBytes file(bytes, part.file.string());
  PhotographReading of_part = reading;
  of_part.page = part.number ? part.number : reading.page;
  DecodedImage stored = decode_image(file, of_part, std::move(memory));
  const auto* const floats = std::get_if<Image<float>>(&stored.photograph.pixels);
  if (floats != nullptr) {
    refuse_infinity(file, *floats);
  }
  if (floats != nullptr || stored.no_data) {
    try {
      leave_out_no_data(stored.photograph, stored.no_data);
    } catch (const Error& error) {
      file.fail(error.what());
    }
  }
  if (floats != nullptr) {
    return std::move(stored.photograph);
  }
  // PNM files may define white as 1023, for example. Many say 65535 whatever their values are.
  const auto white = static_cast<double>(stored.max_value);
  if (const WhiteLevel level{stored.photograph.pixels.index(), white};
      level.scales(stored.photograph)) {
    level.apply(stored.photograph);
  }
  return std::move(stored.photograph);
}

void write_photograph(const std::filesystem::path& path, const Photograph& photograph,
                      Execution* execution) {
  std::vector<std::uint8_t> bytes;
  encode_photograph(path, photograph, bytes, execution);
  write_binary_file(path, bytes);
}

void write_mask(const std::filesystem::path& path, ImageView<const std::uint8_t> mask,
                Execution* execution) {
  if (lower_case_extension(path) != ".png") {
    throw UsageError(fmt::format("cannot write {}: a mask is a .png file", path.string()));
  }
  write_photograph(path, Photograph{Image<std::uint8_t>::copy_of(mask)}, execution);
}

}  // namespace vantage
