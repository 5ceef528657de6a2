#include "engine/io/video/film_properties.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <cstdlib>

#include "engine/io/video/coded_units.h"
#include "engine/io/video/libav_functions.h"
#include "engine/io/video/video_decoder.h"
#include "engine/io/video/video_structure.h"

extern "C" {
#include <libavformat/avformat.h>
#include <libavutil/dict.h>
#include <libavutil/frame.h>
#include <libavutil/stereo3d.h>
}

namespace vantage {
namespace {

/// Data that the container has of a video, null if there is none.
const std::uint8_t* side_data(const AVStream& stream, AVPacketSideDataType type) {
  for (int i = 0; i < stream.nb_side_data; ++i) {
    if (stream.side_data[i].type == type) {
      return stream.side_data[i].data;
    }
  }
  return nullptr;
}

const std::uint8_t* side_data(const AVFrame* frame, AVFrameSideDataType type) {
  const AVFrameSideData* found =
      frame == nullptr ? nullptr : libav().av_frame_get_side_data(frame, type);
  return found == nullptr ? nullptr : found->data;
}

/// Whether two images in one picture are squeezed to half their width or height: films are 1.22 to
/// 2.6 times as wide as high. Panoramas of half a sphere are square, and not squeezed.
bool looks_squeezed(StereoLayout layout, double aspect_of_picture, bool is_panorama) {
  constexpr double kNarrowest = 1.22;
  constexpr double kWidest = 2.6;
  return !is_panorama &&
         ((layout == StereoLayout::kSideBySide && aspect_of_picture / 2 < kNarrowest) ||
          (layout == StereoLayout::kAboveBelow && aspect_of_picture * 2 > kWidest));
}

struct NamedLayout {
  AVStereo3DType type;
  std::optional<StereoLayout> layout;  ///< empty: not read
  std::string_view name;
};

constexpr NamedLayout kLayouts[] = {
    {AV_STEREO3D_SIDEBYSIDE, StereoLayout::kSideBySide, "side by side"},
    {AV_STEREO3D_TOPBOTTOM, StereoLayout::kAboveBelow, "top-bottom"},
    {AV_STEREO3D_FRAMESEQUENCE, StereoLayout::kFrames, "pictures take turns"},
    {AV_STEREO3D_LINES, StereoLayout::kRows, "rows take turns"},
    {AV_STEREO3D_COLUMNS, StereoLayout::kColumns, "columns take turns"},
    {AV_STEREO3D_CHECKERBOARD, std::nullopt, "a checkerboard of both images"},
    {AV_STEREO3D_SIDEBYSIDE_QUINCUNX, std::nullopt, "side by side from a checkerboard"},
};

void take_stereo(const AVStereo3D& stereo, std::string_view where, double aspect, bool is_panorama,
                 FilmProperties& film) {
  const auto* found = std::ranges::find(kLayouts, stereo.type, &NamedLayout::type);
  if (found == std::end(kLayouts)) {
    return;
  }
  const bool right_first = (stereo.flags & AV_STEREO3D_FLAG_INVERT) != 0;
  film.stereo =
      fmt::format("{}, {} first ({})", found->name, right_first ? "right" : "left", where);
  if (found->layout) {
    film.packing = StereoPacking{*found->layout,
                                 looks_squeezed(*found->layout, aspect, is_panorama), right_first};
  }
}

std::string lower_case_tag(const AVStream& stream, const char* name) {
  const AVDictionaryEntry* entry = libav().av_dict_get(stream.metadata, name, nullptr, 0);
  std::string text = entry == nullptr ? "" : entry->value;
  std::ranges::transform(text, text.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

/// By the planes of Matroska ("left_1"), or the name of the track.
std::optional<Side> side_of_track(const AVStream& stream) {
  for (const char* tag : {"stereo_mode", "title", "handler_name"}) {
    const std::string text = lower_case_tag(stream, tag);
    if (text.starts_with("left") && !text.starts_with("left_right")) {
      return Side::kLeft;
    }
    if (text.starts_with("right") && !text.starts_with("right_left")) {
      return Side::kRight;
    }
  }
  return std::nullopt;
}

/// Of a display matrix, which maps the column and the row of a stored pixel; empty: no multiple of
/// 90°.
std::optional<Orientation> orientation_of(const std::int32_t* matrix) {
  struct Turn {
    std::array<int, 4> signs;
    Orientation orientation;
  };
  using enum Orientation;
  constexpr Turn kTurns[] = {{{1, 0, 0, 1}, kAsStored},  {{-1, 0, 0, 1}, kMirror},
                             {{-1, 0, 0, -1}, kTurn180}, {{1, 0, 0, -1}, kFlip},
                             {{0, 1, 1, 0}, kTranspose}, {{0, 1, -1, 0}, kTurn90},
                             {{0, -1, 1, 0}, kTurn270},  {{0, -1, -1, 0}, kTransposeTurn180},
                             {{0, 0, 0, 0}, kAsStored}};  // as some writers leave it
  const std::array<std::int64_t, 4> values = {matrix[0], matrix[1], matrix[3], matrix[4]};
  std::int64_t largest = 0;
  for (const std::int64_t value : values) {
    largest = std::max(largest, std::abs(value));
  }
  std::array<int, 4> signs{};
  for (std::size_t i = 0; i < 4; ++i) {
    const bool is_zero = std::abs(values[i]) * 100 < largest;
    signs[i] = values[i] == 0 || is_zero ? 0 : values[i] > 0 ? 1 : -1;
  }
  const auto* found = std::ranges::find(kTurns, signs, &Turn::signs);
  return found == std::end(kTurns) ? std::nullopt : std::optional(found->orientation);
}

double aspect_of(const AVStream& stream, const AVFrame* frame) {
  AVRational pixel = stream.sample_aspect_ratio;
  if (pixel.num <= 0 && frame != nullptr) {
    pixel = frame->sample_aspect_ratio;
  }
  const AVCodecParameters& shape = *stream.codecpar;
  return static_cast<double>(shape.width) / shape.height *
         (pixel.num > 0 && pixel.den > 0 ? av_q2d(pixel) : 1.0);
}

void take_all_stereo(const AVFormatContext& input, const AVStream& stream, const AVFrame* frame,
                     FilmProperties& film) {
  const std::string_view container = input.iformat->name;
  const double aspect = aspect_of(stream, frame);
  const bool is_panorama = side_data(stream, AV_PKT_DATA_SPHERICAL) != nullptr;
  const auto* in_container =
      reinterpret_cast<const AVStereo3D*>(side_data(stream, AV_PKT_DATA_STEREO3D));
  const auto* in_frame =
      reinterpret_cast<const AVStereo3D*>(side_data(frame, AV_FRAME_DATA_STEREO3D));
  if (in_container != nullptr) {
    const bool is_matroska = container.find("matroska") != std::string_view::npos;
    take_stereo(*in_container,
                is_matroska ? "StereoMode of the container" : "st3d of the container", aspect,
                is_panorama, film);
  } else if (in_frame != nullptr) {
    take_stereo(*in_frame, "frame packing of the bitstream", aspect, is_panorama, film);
  }
}

void take_turn(const AVStream& stream, const AVFrame* frame, FilmProperties& film) {
  const std::uint8_t* matrix = side_data(stream, AV_PKT_DATA_DISPLAYMATRIX);
  if (matrix == nullptr) {
    matrix = side_data(frame, AV_FRAME_DATA_DISPLAYMATRIX);
  }
  if (matrix != nullptr) {
    const auto turn = orientation_of(reinterpret_cast<const std::int32_t*>(matrix));
    film.turn = turn.value_or(Orientation::kAsStored);
    film.turns_askew = !turn;
  }
}

void take_fields(const AVStream& stream, const AVFrame* frame, FilmProperties& film) {
  const AVFieldOrder order = stream.codecpar->field_order;
  film.has_interlaced_flags = frame != nullptr && frame->interlaced_frame != 0;
  film.is_interlaced =
      film.has_interlaced_flags || (order != AV_FIELD_UNKNOWN && order != AV_FIELD_PROGRESSIVE);
  film.upper_field_first = film.has_interlaced_flags ? frame->top_field_first != 0
                                                     : order != AV_FIELD_BB && order != AV_FIELD_TB;
}

void count_tracks(AVFormatContext& input, const AVStream& stream, FilmProperties& film) {
  const std::vector<AVStream*> videos = video_streams(input);
  film.tracks = 0;
  for (std::size_t i = 0; i < videos.size(); ++i) {
    const AVCodecParameters& other = *videos[i]->codecpar;
    film.tracks += other.width == film.width_px && other.height == film.height_px ? 1 : 0;
    film.track = videos[i] == &stream ? static_cast<int>(i) : film.track;
  }
}

}  // namespace

FilmProperties examine_film(const std::filesystem::path& path, int track) {
  VideoDecoder decoder(path, 1, track);
  const AVStream& stream = decoder.stream();
  FilmProperties film;
  film.width_px = stream.codecpar->width;
  film.height_px = stream.codecpar->height;
  film.further_views = further_views(*stream.codecpar, decoder.next_packet());
  if (film.further_views.empty()) {
    film.further_views = further_views_in_boxes(path);
  }
  const AVFrame* frame = decoder.next() == VideoDecoder::Step::kFrame ? &decoder.frame() : nullptr;
  take_all_stereo(decoder.input(), stream, frame, film);
  take_turn(stream, frame, film);
  take_fields(stream, frame, film);
  film.side = side_of_track(stream);
  count_tracks(decoder.input(), stream, film);
  return film;
}

}  // namespace vantage
