#include "engine/io/video/frame_to_photograph.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <string_view>
#include <type_traits>

#include "engine/error.h"
#include "engine/io/video/libav_functions.h"
#include "engine/io/video/libav_scaler.h"

extern "C" {
#include <libavutil/frame.h>
#include <libavutil/pixdesc.h>
#include <libswscale/swscale.h>
}

namespace vantage {
namespace {

constexpr int kFirstRowsOf709 = 720;

/// Integer grey levels in the byte order of this machine.
bool has_plain_intensities(const AVPixFmtDescriptor& format) {
  constexpr auto kNotPlain = AV_PIX_FMT_FLAG_PAL | AV_PIX_FMT_FLAG_BITSTREAM |
                             AV_PIX_FMT_FLAG_HWACCEL | AV_PIX_FMT_FLAG_FLOAT |
                             (std::endian::native == std::endian::little ? AV_PIX_FMT_FLAG_BE : 0U);
  return format.nb_components == 1 && (format.flags & kNotPlain) == 0 && format.comp[0].depth <= 16;
}

/// Value of each sample of `bits` bits, in 0..white.
std::vector<std::uint16_t> grey_levels(int bits, bool limited_range, int white) {
  std::vector<std::uint16_t> levels(std::size_t{1} << bits);
  const double unit = std::ldexp(1.0, bits - 8);
  const double first = limited_range ? 16 * unit : 0;
  const double last = limited_range ? 235 * unit : std::ldexp(1.0, bits) - 1;
  for (std::size_t i = 0; i < levels.size(); ++i) {
    const double level = (static_cast<double>(i) - first) / (last - first);
    levels[i] = static_cast<std::uint16_t>(std::lround(white * std::clamp(level, 0.0, 1.0)));
  }
  return levels;
}

/// Samples have the type of the values they become.
template <typename T>
void convert_grey(const AVFrame& frame, const std::vector<std::uint16_t>& levels, Image<T>& image) {
  for (int y = 0; y < frame.height; ++y) {
    const auto* source =
        reinterpret_cast<const T*>(frame.data[0] + std::ptrdiff_t{y} * frame.linesize[0]);
    T* target = image.row(y);
    for (int x = 0; x < frame.width; ++x) {
      const std::size_t sample = std::min<std::size_t>(source[x], levels.size() - 1);
      target[x] = static_cast<T>(levels[sample]);
    }
  }
}

/// The image of `photograph` as one of T with that shape.
template <typename T>
Image<T>& shape(Photograph& photograph, int width, int height, int channels) {
  Image<T>& image = pixels_of<T>(photograph);
  image.resize(width, height, channels);
  return image;
}

bool is_luma_and_chroma(const AVPixFmtDescriptor& format) {
  constexpr auto kOthers = AV_PIX_FMT_FLAG_RGB | AV_PIX_FMT_FLAG_PAL | AV_PIX_FMT_FLAG_FLOAT;
  return format.nb_components >= 3 && (format.flags & kOthers) == 0 &&
         !std::string_view(format.name).starts_with("xyz");
}

/// The format without the full range implied by some old names.
int without_range(int format) {
  switch (format) {
    case AV_PIX_FMT_YUVJ420P:
      return AV_PIX_FMT_YUV420P;
    case AV_PIX_FMT_YUVJ422P:
      return AV_PIX_FMT_YUV422P;
    case AV_PIX_FMT_YUVJ444P:
      return AV_PIX_FMT_YUV444P;
    case AV_PIX_FMT_YUVJ440P:
      return AV_PIX_FMT_YUV440P;
    case AV_PIX_FMT_YUVJ411P:
      return AV_PIX_FMT_YUV411P;
    default:
      return format;
  }
}

/// Weights of red and blue in luma, for frames of `rows` rows.
std::array<double, 2> luma_weights(AVColorSpace matrix, int rows) {
  constexpr std::array<double, 2> kOf601 = {0.299, 0.114};
  constexpr std::array<double, 2> kOf709 = {0.2126, 0.0722};
  switch (matrix) {
    case AVCOL_SPC_RESERVED:
    case AVCOL_SPC_UNSPECIFIED:
      return rows < kFirstRowsOf709 ? kOf601 : kOf709;
    case AVCOL_SPC_BT709:
      return kOf709;
    case AVCOL_SPC_BT470BG:
    case AVCOL_SPC_SMPTE170M:
      return kOf601;
    case AVCOL_SPC_FCC:
      return {0.30, 0.11};
    case AVCOL_SPC_SMPTE240M:
      return {0.212, 0.087};
    case AVCOL_SPC_BT2020_NCL:
      return {0.2627, 0.0593};
    default:
      throw Error(fmt::format("its colour matrix {} is not supported", static_cast<int>(matrix)));
  }
}

/// For 16-bit luma and chroma that had `bits` bits, and RGB in 0..white.
kernels::ColourFactors make_colour_factors(const std::array<double, 2>& weights, bool full_range,
                                           int bits, double white) {
  const auto [red, blue] = weights;
  const double green = 1 - red - blue;
  const double full = std::ldexp(1.0, 16) - std::ldexp(1.0, 16 - bits);
  const double chroma = white / (full_range ? full : 224.0 * 256);
  return {.black = full_range ? 0.0F : 16.0F * 256,
          .grey = static_cast<float>(white / (full_range ? full : 219.0 * 256)),
          .red_of_red = static_cast<float>(chroma * 2 * (1 - red)),
          .green_of_red = static_cast<float>(chroma * 2 * (1 - red) * red / green),
          .green_of_blue = static_cast<float>(chroma * 2 * (1 - blue) * blue / green),
          .blue_of_blue = static_cast<float>(chroma * 2 * (1 - blue))};
}

}  // namespace

void FrameToPhotograph::prepare(const AVFrame& frame) {
  const Source source{frame.width,      frame.height,      frame.format,
                      frame.colorspace, frame.color_range, frame.chroma_location};
  if (source == source_) {
    return;
  }
  source_ = {};
  const AVPixFmtDescriptor& format = describe_pixel_format(frame.format);
  const int bits = format.comp[0].depth;
  const bool full_range =
      frame.color_range == AVCOL_RANGE_JPEG || without_range(frame.format) != frame.format;
  grey_ = format.nb_components == 1 && (format.flags & AV_PIX_FMT_FLAG_PAL) == 0;
  wide_ = bits > 8;
  has_chroma_ = is_luma_and_chroma(format);
  levels_.clear();
  yuv_.reset();
  scaler_.reset();
  if (has_plain_intensities(format)) {
    levels_ = grey_levels(bits, frame.color_range == AVCOL_RANGE_MPEG, wide_ ? 65535 : 255);
    source_ = source;
    return;
  }
  if (libav().sws_isSupportedInput(static_cast<AVPixelFormat>(frame.format)) == 0) {
    throw Error(fmt::format("its pixel format {} is not supported", format.name));
  }
  if (has_chroma_) {
    // libswscale only interpolates chroma, because its RGB wraps around far outside the range, and
    // its RGB of more than 8 bits is up to one 8-bit level too dark.
    factors_ = make_colour_factors(luma_weights(frame.colorspace, frame.height), full_range, bits,
                                   wide_ ? 65535 : 255);
  }
  if (has_chroma_ && !ChromaUpsampler::serves(frame)) {
    yuv_ = make_picture(frame.width, frame.height, AV_PIX_FMT_YUV444P16);
    scaler_ = make_scaler({.width = frame.width,
                           .height = frame.height,
                           .source_format = without_range(frame.format),
                           .target_format = AV_PIX_FMT_YUV444P16,
                           .source_full_range = false,
                           .target_full_range = false,
                           .source_chroma = chroma_position(frame.chroma_location, format)});
  } else if (!has_chroma_) {
    scaler_ = make_scaler({.width = frame.width,
                           .height = frame.height,
                           .source_format = frame.format,
                           .target_format = grey_ ? (wide_ ? AV_PIX_FMT_GRAY16 : AV_PIX_FMT_GRAY8)
                                                  : (wide_ ? AV_PIX_FMT_RGB48 : AV_PIX_FMT_RGB24)});
  }
  source_ = source;
}

void FrameToPhotograph::convert(const AVFrame& frame, Photograph& photograph) {
  prepare(frame);
  const int channels = grey_ ? 1 : 3;
  Photograph* const whole[] = {&photograph};
  if (has_chroma_) {
    wide_ ? fill_colours<std::uint16_t>(frame, whole) : fill_colours<std::uint8_t>(frame, whole);
  } else if (wide_) {
    fill(frame, shape<std::uint16_t>(photograph, frame.width, frame.height, channels));
  } else {
    fill(frame, shape<std::uint8_t>(photograph, frame.width, frame.height, channels));
  }
}

bool FrameToPhotograph::convert_halves(const AVFrame& frame, const PictureHalves& halves) {
  prepare(frame);
  if (!has_chroma_ || frame.width % 2 != 0) {
    return false;
  }
  wide_ ? fill_colours<std::uint16_t>(frame, halves) : fill_colours<std::uint8_t>(frame, halves);
  return true;
}

void FrameToPhotograph::scale(const AVFrame& frame, std::uint8_t* const* planes,
                              const int* pitches) {
  if (libav().sws_scale(scaler_.get(), frame.data, frame.linesize, 0, frame.height, planes,
                        pitches) != frame.height) {
    throw Error("its pixel format is not supported");
  }
}

template <typename T>
void FrameToPhotograph::fill(const AVFrame& frame, Image<T>& image) {
  if (!levels_.empty()) {
    convert_grey(frame, levels_, image);
    return;
  }
  const std::array<std::uint8_t*, 4> rgb = {reinterpret_cast<std::uint8_t*>(image.row(0))};
  const std::array<int, 4> rgb_pitch = {static_cast<int>(image.view().stride() * sizeof(T))};
  scale(frame, rgb.data(), rgb_pitch.data());
}

kernels::LumaChromaRow FrameToPhotograph::next_row(int y) {
  if (yuv_ == nullptr) {
    return upsampler_.next_row();
  }
  const auto row = [&](int plane) {
    return reinterpret_cast<const std::uint16_t*>(yuv_->data[plane] +
                                                  std::ptrdiff_t{y} * yuv_->linesize[plane]);
  };
  return {row(0), row(1), row(2), yuv_->width};
}

template <typename T>
void FrameToPhotograph::fill_colours(const AVFrame& frame, std::span<Photograph* const> parts) {
  if (yuv_ == nullptr) {
    upsampler_.begin(frame);
  } else {
    scale(frame, yuv_->data, yuv_->linesize);
  }
  const int width = frame.width / static_cast<int>(parts.size());
  for (Photograph* const part : parts) {
    if (part != nullptr) {
      shape<T>(*part, width, frame.height, 3);
    }
  }
  for (int y = 0; y < frame.height; ++y) {
    kernels::LumaChromaRow row = next_row(y);
    row.width = width;
    for (Photograph* const part : parts) {
      if (part != nullptr) {
        kernels::rgb_row(row, factors_, pixels_of<T>(*part).row(y));
      }
      row.luma += width;
      row.chroma_blue += width;
      row.chroma_red += width;
    }
  }
}

}  // namespace vantage
