#pragma once

#include <string>

#include "engine/io/video/film_format.h"

struct AVFrame;
struct AVStream;

namespace vantage {

/// What `stream` states of its pictures; `frame`, one of them, may be null. A film may have the
/// display of its grading in its frames only.
FilmFormat stated_format(const AVStream& stream, const AVFrame* frame);

/// "pixels 4:3, 10 bits, primaries bt2020, transfer smpte2084, matrix bt2020nc"; empty where there
/// is nothing but the usual: square pixels, 8 bits, BT.709 or nothing stated.
std::string to_text(const FilmFormat& format);

/// The colours of a film made of pictures of a film with `source`. All as stated, where a coding of
/// R, G and B can have them; a film that states nothing, or its matrix alone as BT.709, is BT.709,
/// as players take it.
FilmColours written_colours(const FilmColours& source);

}  // namespace vantage
