#include "engine/io/video/stated_format.h"

#include <fmt/format.h>

#include <cstddef>
#include <string>
#include <string_view>

#include "engine/io/video/libav_functions.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/frame.h>
#include <libavutil/mastering_display_metadata.h>
#include <libavutil/pixdesc.h>
}

namespace vantage {
namespace {

std::string text_of(const AVMasteringDisplayMetadata& display) {
  if (display.has_primaries == 0 || display.has_luminance == 0) {
    return "";
  }
  const auto point = [](const AVRational(&position)[2]) {
    constexpr double kUnits = 50000;
    return fmt::format("({:.0f},{:.0f})", kUnits * av_q2d(position[0]),
                       kUnits * av_q2d(position[1]));
  };
  constexpr double kUnits = 10000;  // of a cd/m²
  return fmt::format("G{}B{}R{}WP{}L({:.0f},{:.0f})", point(display.display_primaries[1]),
                     point(display.display_primaries[2]), point(display.display_primaries[0]),
                     point(display.white_point), kUnits * av_q2d(display.max_luminance),
                     kUnits * av_q2d(display.min_luminance));
}

std::string text_of(const AVContentLightMetadata& level) {
  return fmt::format("{},{}", level.MaxCLL, level.MaxFALL);
}

/// Of the stream, else of the frame; "" where neither has it.
template <typename T>
std::string side_data_text(const AVStream& stream, AVPacketSideDataType of_stream,
                           const AVFrame* frame, AVFrameSideDataType of_frame) {
  for (int i = 0; i < stream.nb_side_data; ++i) {
    const AVPacketSideData& data = stream.side_data[i];
    if (data.type == of_stream && data.size >= sizeof(T)) {
      return text_of(*reinterpret_cast<const T*>(data.data));
    }
  }
  const AVFrameSideData* const data =
      frame == nullptr ? nullptr : libav().av_frame_get_side_data(frame, of_frame);
  return data != nullptr && data->size >= sizeof(T)
             ? text_of(*reinterpret_cast<const T*>(data->data))
             : "";
}

bool is_made_of_rgb(int matrix) {
  switch (matrix) {
    case AVCOL_SPC_BT709:
    case AVCOL_SPC_FCC:
    case AVCOL_SPC_BT470BG:
    case AVCOL_SPC_SMPTE170M:
    case AVCOL_SPC_SMPTE240M:
    case AVCOL_SPC_BT2020_NCL:
      return true;
    default:
      return false;
  }
}

}  // namespace

FilmFormat stated_format(const AVStream& stream, const AVFrame* frame) {
  const AVCodecParameters& parameters = *stream.codecpar;
  FilmFormat format;
  const AVRational aspect = stream.sample_aspect_ratio.num > 0 ? stream.sample_aspect_ratio
                                                               : parameters.sample_aspect_ratio;
  if (aspect.num > 0 && aspect.den > 0) {
    format.pixel_aspect = {aspect.num, aspect.den};
  }
  const int pixel_format = frame != nullptr ? frame->format : parameters.format;
  FilmColours& colours = format.colours;
  colours.primaries = frame != nullptr ? frame->color_primaries : parameters.color_primaries;
  colours.transfer = frame != nullptr ? frame->color_trc : parameters.color_trc;
  colours.matrix = frame != nullptr ? frame->colorspace : parameters.color_space;
  const int range = frame != nullptr ? frame->color_range : parameters.color_range;
  if (const AVPixFmtDescriptor* pixels =
          libav().av_pix_fmt_desc_get(static_cast<AVPixelFormat>(pixel_format))) {
    const bool is_rgb = (pixels->flags & AV_PIX_FMT_FLAG_RGB) != 0;
    colours.bits = pixels->comp[0].depth;
    colours.has_full_range = !is_rgb && (range == AVCOL_RANGE_JPEG ||
                                         std::string_view(pixels->name).starts_with("yuvj"));
  }
  colours.mastering_display =
      side_data_text<AVMasteringDisplayMetadata>(stream, AV_PKT_DATA_MASTERING_DISPLAY_METADATA,
                                                 frame, AV_FRAME_DATA_MASTERING_DISPLAY_METADATA);
  colours.light_level = side_data_text<AVContentLightMetadata>(
      stream, AV_PKT_DATA_CONTENT_LIGHT_LEVEL, frame, AV_FRAME_DATA_CONTENT_LIGHT_LEVEL);
  return format;
}

std::string to_text(const FilmFormat& format) {
  std::string text;
  const auto add = [&](const std::string& part) { text += (text.empty() ? "" : ", ") + part; };
  if (const PixelAspect& aspect = format.pixel_aspect; aspect != PixelAspect()) {
    add(fmt::format("pixels {}:{}", aspect.width, aspect.height));
  }
  const FilmColours& colours = format.colours;
  if (colours.bits > 8) {
    add(fmt::format("{} bits", colours.bits));
  }
  if (colours.has_full_range) {
    add("full range");
  }
  const FilmColours written = written_colours(colours, VideoCoding::kHevcColours_10);
  if (written.primaries == AVCOL_PRI_BT709 && written.transfer == AVCOL_TRC_BT709 &&
      written.matrix == AVCOL_SPC_BT709) {
    return text;
  }
  const auto add_name = [&](const char* kind, int number, const char* name) {
    if (number != FilmColours::kNotStated) {
      add(fmt::format("{} {}", kind, name == nullptr ? "unknown" : name));
    }
  };
  add_name("primaries", colours.primaries,
           libav().av_color_primaries_name(static_cast<AVColorPrimaries>(colours.primaries)));
  add_name(
      "transfer", colours.transfer,
      libav().av_color_transfer_name(static_cast<AVColorTransferCharacteristic>(colours.transfer)));
  add_name("matrix", colours.matrix,
           libav().av_color_space_name(static_cast<AVColorSpace>(colours.matrix)));
  return text;
}

VideoCoding colour_coding(const FilmColours& source) {
  const bool has_hevc = libav().avcodec_find_encoder_by_name(
                            traits_of(VideoCoding::kHevcColours_10).encoder) != nullptr;
  return has_hevc && (source.bits > 8 || source.is_hdr()) ? VideoCoding::kHevcColours_10
                                                          : VideoCoding::kH264;
}

const char* written_as(const FilmColours& source) {
  return colour_coding(source) == VideoCoding::kHevcColours_10
             ? "videos of views state the same (HEVC, 10 bits)"
         : source.is_hdr() ? "without an encoder of HEVC views are tone-mapped to BT.709"
                           : "videos of views state the same (H.264, 8 bits)";
}

FilmColours written_colours(const FilmColours& source, VideoCoding coding) {
  if (source.is_hdr() && coding == VideoCoding::kH264) {
    return written_colours({}, coding);
  }
  FilmColours written = source;
  if (!is_made_of_rgb(source.matrix)) {
    written.matrix = source.primaries == AVCOL_PRI_BT2020 ? AVCOL_SPC_BT2020_NCL : AVCOL_SPC_BT709;
  }
  // The numbers before 1 and after it are of no colours.
  const bool is_bt709 = source.matrix == AVCOL_SPC_UNSPECIFIED || source.matrix == AVCOL_SPC_RGB ||
                        source.matrix == AVCOL_SPC_BT709;
  for (int* const stated : {&written.primaries, &written.transfer}) {
    if (*stated == 0 || *stated == FilmColours::kNotStated) {
      *stated = is_bt709 ? 1 : FilmColours::kNotStated;
    }
  }
  return written;
}

}  // namespace vantage
