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
#include "engine/io/video/libav_scaler.h"
#include "engine/io/video/stated_format.h"

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
  GreyToFrame(const VideoCodingTraits& coding, int width, int height) : coding_(coding) {
    const auto side = [&](int px) { return coding.has_odd_sizes ? px : even(px); };
    frame_ = make_picture(side(width), side(height), coding.pixel_format);
    frame_->color_range = coding.has_full_range ? AVCOL_RANGE_JPEG : AVCOL_RANGE_MPEG;
  }

  AVFrame& convert(const Photograph& photograph) {
    const auto* grey = std::get_if<Image<std::uint16_t>>(&photograph.pixels);
    if (grey == nullptr || grey->channels() != 1) {
      throw Error("a frame of a grey video has colours or another depth, expected 16-bit grey");
    }
    if (av_frame_make_writable(frame_.get()) < 0) {
      throw std::bad_alloc();
    }
    for (int y = 0; y < frame_->height; ++y) {
      const std::uint16_t* source = grey->row(std::min(y, grey->height() - 1));
      std::uint16_t* target = row(0, y);
      for (int x = 0; x < frame_->width; ++x) {
        target[x] = code_of(source[std::min(x, grey->width() - 1)]);
      }
      if (!coding_.has_full_range) {
        constexpr std::uint16_t kNoChroma = 512;
        std::fill_n(row(1, y), frame_->width / 2, kNoChroma);
        std::fill_n(row(2, y), frame_->width / 2, kNoChroma);
      }
    }
    return *frame_;
  }

 private:
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

  [[nodiscard]] std::uint16_t* row(int plane, int y) const {
    return reinterpret_cast<std::uint16_t*>(frame_->data[plane] +
                                            std::ptrdiff_t{y} * frame_->linesize[plane]);
  }

  const VideoCodingTraits& coding_;
  LibavFrame frame_;
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

/// `Sample`: of R, G and B.
template <typename Sample>
class PhotographToFrame {
 public:
  PhotographToFrame(const VideoCodingTraits& coding, int width, int height,
                    const FilmColours& source)
      : width_(even(width)), height_(even(height)) {
    constexpr auto kRgb = sizeof(Sample) == 1 ? AV_PIX_FMT_RGB24 : AV_PIX_FMT_RGB48;
    const FilmColours colours = written_colours(
        source, sizeof(Sample) == 1 ? VideoCoding::kH264 : VideoCoding::kHevcColours_10);
    rgb_ = make_picture(width_, height_, kRgb);
    yuv_ = make_picture(width_, height_, coding.pixel_format);
    yuv_->color_primaries = static_cast<AVColorPrimaries>(colours.primaries);
    yuv_->color_trc = static_cast<AVColorTransferCharacteristic>(colours.transfer);
    yuv_->colorspace = static_cast<AVColorSpace>(colours.matrix);
    yuv_->color_range = colours.has_full_range ? AVCOL_RANGE_JPEG : AVCOL_RANGE_MPEG;
    yuv_->chroma_location = AVCHROMA_LOC_LEFT;
    scaler_ = make_scaler(
        {.width = width_,
         .height = height_,
         .source_format = kRgb,
         .target_format = coding.pixel_format,
         .target_full_range = colours.has_full_range,
         .matrix = colours.matrix,  // libswscale's numbers are the same
         .target_chroma = chroma_position(AVCHROMA_LOC_LEFT, describe_pixel_format(yuv_->format))});
  }

  AVFrame& convert(const Photograph& photograph) {
    if (av_frame_make_writable(yuv_.get()) < 0) {
      throw std::bad_alloc();
    }
    const auto* bytes = std::get_if<Image<std::uint8_t>>(&photograph.pixels);
    if (sizeof(Sample) == 1 && bytes != nullptr && bytes->channels() == 3 &&
        bytes->width() == width_ && bytes->height() == height_) {
      const std::array<const std::uint8_t*, 4> rgb = {bytes->row(0)};
      const std::array<int, 4> pitch = {static_cast<int>(bytes->view().stride())};
      sws_scale(scaler_.get(), rgb.data(), pitch.data(), 0, height_, yuv_->data, yuv_->linesize);
      return *yuv_;
    }
    std::visit([&](const auto& image) { fill_rgb<Sample>(image, *rgb_); }, photograph.pixels);
    sws_scale(scaler_.get(), rgb_->data, rgb_->linesize, 0, height_, yuv_->data, yuv_->linesize);
    return *yuv_;
  }

 private:
  int width_;
  int height_;
  LibavScaler scaler_;
  LibavFrame rgb_;
  LibavFrame yuv_;
};

/// HDR for a coding of 8 bits: SDR of BT.709, by FFmpeg's filters.
class HdrToSdrFrame {
 public:
  HdrToSdrFrame(int width, int height, const FilmColours& source)
      : to_hdr_(traits_of(VideoCoding::kHevcColours_10), width, height, source) {}

  AVFrame& convert(const Photograph& photograph) {
    // White of SDR at 100 cd/m², the brightest at 1000, as most films are graded.
    constexpr const char* kToneMapping =
        "zscale=transfer=linear:npl=100,format=gbrpf32le,zscale=primaries=bt709,"
        "tonemap=hable:desat=0:peak=10,zscale=transfer=bt709:matrix=bt709:range=limited,"
        "format=yuv420p";
    const AVFrame& hdr = to_hdr_.convert(photograph);
    if (!filter_) {
      filter_.emplace(kToneMapping, hdr);
    }
    filter_->put(hdr);
    sdr_ = filter_->take();
    if (sdr_ == nullptr) {
      throw Error("a picture of HDR cannot be tone-mapped");
    }
    return *sdr_;
  }

 private:
  PhotographToFrame<std::uint16_t> to_hdr_;
  std::optional<LibavFilter> filter_;
  LibavFrame sdr_;
};

}  // namespace

FrameConversion make_frame_conversion(VideoCoding coding, int width, int height,
                                      const FilmColours& source) {
  const auto calls = [](auto conversion) -> FrameConversion {
    return [conversion](const Photograph& frame) -> AVFrame& { return conversion->convert(frame); };
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
