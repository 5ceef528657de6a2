#pragma once

#include <string>

#include "engine/io/video/film_format.h"
#include "engine/io/video/video_coding.h"

struct AVFrame;
struct AVStream;

namespace vantage {

/// What `stream` states of its pictures; `frame`, one of them, may be null. A film may have the
/// display of its grading in its frames only.
FilmFormat stated_format(const AVStream& stream, const AVFrame* frame);

/// "pixels 4:3, 10 bits, primaries bt2020, transfer smpte2084, matrix bt2020nc"; empty where there
/// is nothing but the usual: square pixels, 8 bits, BT.709 or nothing stated.
std::string to_text(const FilmFormat& format);

/// The coding of colours for pictures of a film with `source`: HEVC with 10 bits for more than 8
/// and for HDR, H.264 otherwise and where this FFmpeg has no encoder of HEVC.
VideoCoding colour_coding(const FilmColours& source);

/// The colours of such a film. All as stated, where a coding of R, G and B can have them; a film
/// that states nothing, or its matrix alone as BT.709, is BT.709, as players take it. So is HDR in
/// H.264: it is tone-mapped.
FilmColours written_colours(const FilmColours& source, VideoCoding coding);
/// What becomes of it, for a remark.
const char* written_as(const FilmColours& source);

}  // namespace vantage
