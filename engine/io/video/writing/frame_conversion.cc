#include "engine/io/video/writing/frame_conversion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <new>
#include <optional>
#include <type_traits>

#include "engine/error.h"
#include "engine/io/video/libav_filter.h"
#include "engine/io/video/libav_functions.h"
#include "engine/io/video/libav_scaler.h"
#include "engine/io/video/stated_format.h"
#include "kernels/chroma_rows/chroma_rows.h"

extern "C" {
#include <libavutil/frame.h>
#include <libavutil/pixdesc.h>
#include <libswscale/swscale.h>
}

namespace vantage {
namespace {

int even(int side_px) { return (side_px + 1) / 2 * 2; }

/// The 10-bit code of a 16-bit one.
std::uint16_t ten_bits(std::uint16_t value) {
  return static_cast<std::uint16_t>(value == 0 ? 0 : 1 + ((value - 1) * 1022U + 32767) / 65534);
}

class GreyToFrame {
 public:
  GreyToFrame(const VideoCodingTraits& coding, int width, int height)
      : coding_(coding),
        width_(side(width)),
        height_(side(height)),
        frames_(width_, height_, coding.pixel_format) {}

  [[nodiscard]] LibavFrame convert(const Photograph& photograph) {
    const auto* grey = std::get_if<Image<std::uint16_t>>(&photograph.pixels);
    if (grey == nullptr || grey->channels() != 1) {
      throw Error("a frame of a grey video has colours or another depth, expected 16-bit grey");
    }
    LibavFrame frame = frames_.make();
    frame->color_range = coding_.has_full_range ? AVCOL_RANGE_JPEG : AVCOL_RANGE_MPEG;
    const auto row = [&](int plane, int y) {
      return reinterpret_cast<std::uint16_t*>(frame->data[plane] +
                                              std::ptrdiff_t{y} * frame->linesize[plane]);
    };
    for (int y = 0; y < height_; ++y) {
      const std::uint16_t* source = grey->row(std::min(y, grey->height() - 1));
      std::uint16_t* target = row(0, y);
      for (int x = 0; x < width_; ++x) {
        target[x] = code_of(source[std::min(x, grey->width() - 1)]);
      }
      if (!coding_.has_full_range) {
        constexpr std::uint16_t kNoChroma = 512;
        std::fill_n(row(1, y), width_ / 2, kNoChroma);
        std::fill_n(row(2, y), width_ / 2, kNoChroma);
      }
    }
    return frame;
  }

 private:
  [[nodiscard]] int side(int px) const {
    return coding_.has_odd_sizes ? std::max(2, px) : even(px);
  }
  [[nodiscard]] std::uint16_t code_of(std::uint16_t value) const {
    constexpr unsigned kBlack = 64;      // of limited range, 10 bits
    constexpr unsigned kLumaSpan = 876;  // from black to white
    if (coding_.bits == 16) {
      return value;
    }
    const std::uint16_t code = ten_bits(value);
    return coding_.has_full_range
               ? code
               : static_cast<std::uint16_t>(kBlack + (code * kLumaSpan + 511) / 1023);
  }

  const VideoCodingTraits& coding_;
  int width_;
  int height_;
  PicturePool frames_;
};

/// Value of 8 bits, or of 16 bits as libswscale takes them, from any depth, rounded.
template <typename Sample, typename T>
Sample to_sample(T value) {
  // White of 16 bits is 255 * 256 there.
  constexpr unsigned kWhite = sizeof(Sample) == 1 ? 255 : 65280;
  if constexpr (std::is_floating_point_v<T>) {
    return static_cast<Sample>(
        std::lround(static_cast<float>(kWhite) * std::clamp(value, 0.0F, 1.0F)));
  } else {
    constexpr unsigned kMax = std::numeric_limits<T>::max();
    return static_cast<Sample>((value * kWhite + kMax / 2) / kMax);
  }
}

/// Fills `rgb`, which may be a column and a row larger than the image: those repeat the last.
template <typename Sample, typename T>
void fill_rgb(const Image<T>& image, AVFrame& rgb) {
  const int channels = image.channels();
  const int green = channels >= 3 ? 1 : 0;
  const int blue = channels >= 3 ? 2 : 0;
  for (int y = 0; y < rgb.height; ++y) {
    const T* source = image.row(std::min(y, image.height() - 1));
    auto* target = reinterpret_cast<Sample*>(rgb.data[0] + std::ptrdiff_t{y} * rgb.linesize[0]);
    for (int x = 0; x < rgb.width; ++x) {
      const T* pixel = source + std::min(x, image.width() - 1) * channels;
      target[3 * x] = to_sample<Sample>(pixel[0]);
      target[3 * x + 1] = to_sample<Sample>(pixel[green]);
      target[3 * x + 2] = to_sample<Sample>(pixel[blue]);
    }
  }
}

/// Of the inverse matrix that libswscale has for its number, which is FFmpeg's.
kernels::ChromaFactors chroma_factors(const FilmColours& colours) {
  const int* inverse = libav().sws_getCoefficients(colours.matrix);
  const auto weight = [](int factor) { return 1 - factor * 224.0 / 255 / (2 * 65536); };
  const double red = weight(inverse[0]);
  const double blue = weight(inverse[1]);
  const double luma = colours.has_full_range ? 1 : 219.0 / 255;
  const double chroma = (colours.has_full_range ? 1 : 224.0 / 255) / 2;
  // Each factor rounded, but for green: of white the sum is exact, and a grey has no chroma.
  const auto factors_of = [](double of_red, double of_blue, double of_grey) {
    const auto fixed = [](double factor) {
      return static_cast<std::int32_t>(std::lround(std::ldexp(factor, 15)));
    };
    return std::array{fixed(of_red), fixed(of_grey) - fixed(of_red) - fixed(of_blue),
                      fixed(of_blue)};
  };
  return {.luma = factors_of(red * luma, blue * luma, luma),
          .chroma_blue = factors_of(-red * chroma / (1 - blue), chroma, 0),
          .chroma_red = factors_of(chroma, -blue * chroma / (1 - red), 0),
          .black = colours.has_full_range ? 0 : 16};
}

/// `Sample`: of R, G and B.
template <typename Sample>
class PhotographToFrame {
 public:
  PhotographToFrame(const VideoCodingTraits& coding, int width, int height,
                    const FilmColours& source)
      : width_(even(width)),
        height_(even(height)),
        format_(coding.pixel_format),
        frames_(width_, height_, format_),
        colours_(written_colours(source,
                                 kHasBytes ? VideoCoding::kH264 : VideoCoding::kHevcColours_10)) {
    if constexpr (kHasBytes) {
      factors_ = chroma_factors(colours_);
    } else {
      scaler_ = make_scaler(
          {.width = width_,
           .height = height_,
           .source_format = kRgb,
           .target_format = format_,
           .target_full_range = colours_.has_full_range,
           .matrix = colours_.matrix,  // libswscale's numbers are the same
           .target_chroma = chroma_position(AVCHROMA_LOC_LEFT, describe_pixel_format(format_))});
    }
  }

  LibavFrame convert(const Photograph& photograph) {
    LibavFrame yuv = frames_.make();
    yuv->color_primaries = static_cast<AVColorPrimaries>(colours_.primaries);
    yuv->color_trc = static_cast<AVColorTransferCharacteristic>(colours_.transfer);
    yuv->colorspace = static_cast<AVColorSpace>(colours_.matrix);
    yuv->color_range = colours_.has_full_range ? AVCOL_RANGE_JPEG : AVCOL_RANGE_MPEG;
    yuv->chroma_location = AVCHROMA_LOC_LEFT;
    const auto* bytes = std::get_if<Image<std::uint8_t>>(&photograph.pixels);
    if (kHasBytes && bytes != nullptr && bytes->channels() == 3 && bytes->width() == width_ &&
        bytes->height() == height_) {
      fill(*yuv, bytes->row(0), static_cast<int>(bytes->view().stride()));
      return yuv;
    }
    if (rgb_ == nullptr) {
      rgb_ = make_picture(width_, height_, kRgb);
    }
    std::visit([&](const auto& image) { fill_rgb<Sample>(image, *rgb_); }, photograph.pixels);
    fill(*yuv, rgb_->data[0], rgb_->linesize[0]);
    return yuv;
  }

 private:
  static constexpr bool kHasBytes = sizeof(Sample) == 1;
  static constexpr auto kRgb = kHasBytes ? AV_PIX_FMT_RGB24 : AV_PIX_FMT_RGB48;

  void fill(AVFrame& yuv, const std::uint8_t* rgb, int pitch) const {
    if constexpr (kHasBytes) {
      const auto row = [&](int plane, int y) {
        return yuv.data[plane] + std::ptrdiff_t{y} * yuv.linesize[plane];
      };
      for (int y = 0; y < height_; y += 2) {
        const std::uint8_t* upper = rgb + std::ptrdiff_t{y} * pitch;
        kernels::chroma_rows({.rgb = {upper, upper + pitch},
                              .luma = {row(0, y), row(0, y + 1)},
                              .chroma_blue = row(1, y / 2),
                              .chroma_red = row(2, y / 2),
                              .width = width_},
                             factors_);
      }
    } else {
      const std::array<const std::uint8_t*, 4> planes = {rgb};
      const std::array<int, 4> pitches = {pitch};
      libav().sws_scale(scaler_.get(), planes.data(), pitches.data(), 0, height_, yuv.data,
                        yuv.linesize);
    }
  }

  int width_;
  int height_;
  int format_;
  PicturePool frames_;
  FilmColours colours_;
  kernels::ChromaFactors factors_;  // for bytes
  LibavScaler scaler_;              // else
  LibavFrame rgb_;
};

/// HDR for a coding of 8 bits: SDR of BT.709, by FFmpeg's filters.
class HdrToSdrFrame {
 public:
  HdrToSdrFrame(int width, int height, const FilmColours& source)
      : to_hdr_(traits_of(VideoCoding::kHevcColours_10), width, height, source) {}

  LibavFrame convert(const Photograph& photograph) {
    // White of SDR at 100 cd/m², the brightest at 1000, as most films are graded.
    constexpr const char* kToneMapping =
        "zscale=transfer=linear:npl=100,format=gbrpf32le,zscale=primaries=bt709,"
        "tonemap=hable:desat=0:peak=10,zscale=transfer=bt709:matrix=bt709:range=limited,"
        "format=yuv420p";
    const LibavFrame hdr = to_hdr_.convert(photograph);
    if (!filter_) {
      filter_.emplace(kToneMapping, *hdr);
    }
    filter_->put(*hdr);
    LibavFrame sdr = filter_->take();
    if (sdr == nullptr) {
      throw Error("a picture of HDR cannot be tone-mapped");
    }
    return sdr;
  }

 private:
  PhotographToFrame<std::uint16_t> to_hdr_;
  std::optional<LibavFilter> filter_;
};

}  // namespace

FrameConversion make_frame_conversion(VideoCoding coding, int width, int height,
                                      const FilmColours& source) {
  const auto calls = [](auto conversion) -> FrameConversion {
    return [conversion](const Photograph& frame) { return conversion->convert(frame); };
  };
  const VideoCodingTraits& traits = traits_of(coding);
  if (is_grey(coding)) {
    return calls(std::make_shared<GreyToFrame>(traits, width, height));
  }
  if (source.is_hdr() && coding == VideoCoding::kH264) {
    return calls(std::make_shared<HdrToSdrFrame>(width, height, source));
  }
  return traits.bits > 8 ? calls(std::make_shared<PhotographToFrame<std::uint16_t>>(traits, width,
                                                                                    height, source))
                         : calls(std::make_shared<PhotographToFrame<std::uint8_t>>(traits, width,
                                                                                   height, source));
}

}  // namespace vantage
