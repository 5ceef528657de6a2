#include "engine/sequence/film_remark.h"

#include <fmt/format.h>

#include <string>

#include "engine/io/video/stated_format.h"

namespace vantage {

std::optional<Remark> film_remark(const FilmFormat& film, const SequenceOptions& options,
                                  bool is_streamed) {
  const std::string stated = to_text(film);
  if (stated.empty()) {
    return std::nullopt;
  }
  const bool shows_film =
      options.saves(SequenceOutput::kViews) || options.saves(SequenceOutput::kStereo);
  const bool in_videos = options.saves_as_video(SequenceOutput::kViews) ||
                         options.saves_as_video(SequenceOutput::kStereo);
  std::string fate = "matched as it is coded";
  if (is_streamed) {
    fate += "; y4m states the shape of pixels and the range alone";
  } else if (in_videos) {
    fate += fmt::format("; videos of views state the same{}",
                        film.colours.bits > 8 ? " (HEVC, 10 bits)" : "");
  } else if (shows_film) {
    fate += "; images of views have its values, and state nothing of it";
  }
  if (film.pixel_aspect != options.film.pixel_aspect) {
    fate += "; rectified pixels are square";
  }
  return Remark{Remark::Kind::kNote, "film", fmt::format("the film has {}: {}", stated, fate)};
}

}  // namespace vantage
