#include "engine/sequence/pairs/stereo_film.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "engine/error.h"
#include "engine/io/images/stereo_jpeg.h"
#include "engine/sequence/pairs/frame_pairing.h"
#include "engine/sequence/pairs/moving_camera_pairs.h"
#include "engine/sequence/pairs/packed_pairs.h"
#include "engine/sequence/pairs/two_camera_pairs.h"

namespace vantage {
namespace {

[[noreturn]] void refuse_further_views(const std::string& file, std::string_view coding) {
  throw Error(fmt::format(
      "{}: holds {}: its second view is in the same stream, and this FFmpeg decodes the base view "
      "only; expected two videos or both images in one picture{}",
      file, coding,
      coding == "MVC" ? ", as a decoder of MVC (FRIM, the reference software JM) makes them"
                      : ", as FFmpeg 7.1 makes them: ffmpeg -i FILE -map 0:v:vpos:left left.mkv "
                        "-map 0:v:vpos:right right.mkv"));
}

std::unique_ptr<PairSource> two_cameras(std::unique_ptr<FrameSource> left,
                                        std::unique_ptr<FrameSource> right) {
  FramePairing pairing = pair_frames({left.get(), right.get()}, 0, {});
  return std::make_unique<TwoCameraPairs>(std::move(left), std::move(right), std::move(pairing));
}

/// The pairs of MPO and JPS files, each of which is read for either side.
std::unique_ptr<PairSource> open_views(const PairSourceOptions& options) {
  const auto open_view = [&](int view) {
    PhotographReading reading = options.reading;
    reading.page = view;
    return open_frame_source(options.stereo, reading);
  };
  return two_cameras(open_view(0), open_view(1));
}

/// The two video tracks of a film as two cameras.
std::unique_ptr<PairSource> open_tracks(const PairSourceOptions& options,
                                        std::vector<std::string>& notes) {
  const auto open_track = [&](int track) {
    return open_noted_source(fmt::format("{}#{}", options.stereo, track), options.reading, notes);
  };
  std::unique_ptr<FrameSource> left = open_track(0);
  std::unique_ptr<FrameSource> right = open_track(1);
  const bool is_named = left->film()->side || right->film()->side;
  if (left->film()->side == Side::kRight || right->film()->side == Side::kLeft) {
    std::swap(left, right);
  }
  notes.push_back(fmt::format("{} has two video tracks: the left image is #{}, the right one #{}{}",
                              options.stereo, left->film()->track, right->film()->track,
                              is_named ? ", as their names say" : " (assumed)"));
  return two_cameras(std::move(left), std::move(right));
}

/// What the shape of the pictures was taken for: files do not say it.
std::string size_assumed(StereoPacking packing, const FilmProperties& film) {
  if (packing.layout != StereoLayout::kSideBySide && packing.layout != StereoLayout::kAboveBelow) {
    return "";
  }
  StereoPacking other = packing;
  other.half_size = !packing.half_size;
  return fmt::format("; from its {}x{} pixels, images of {} size are assumed (else `packing` {})",
                     film.width_px, film.height_px, packing.half_size ? "half" : "full",
                     to_name(other));
}

StereoPacking packing_of_film(const std::string& file, const FilmProperties* film,
                              std::vector<std::string>& notes) {
  if (film == nullptr || !film->packing) {
    throw UsageError(fmt::format(
        "`stereo` needs `packing`, such as sbsl: {} {}", file,
        film != nullptr && !film->stereo.empty()
            ? fmt::format("is {}, which is not read", film->stereo)
        : film != nullptr && film->tracks > 2
            ? fmt::format("has {} video tracks; or give left and right, such as {}#0 and {}#1",
                          film->tracks, file, file)
            : "does not say where both images are"));
  }
  notes.push_back(fmt::format("{} says {}: `packing` {}{}", file, film->stereo,
                              to_name(*film->packing), size_assumed(*film->packing, *film)));
  return *film->packing;
}

/// A note where the film says something else than the user.
void note_contradiction(const std::string& file, const FilmProperties* film, StereoPacking given,
                        std::vector<std::string>& notes) {
  if (film == nullptr) {
    return;
  }
  const bool differs = film->packing && (film->packing->layout != given.layout ||
                                         film->packing->right_first != given.right_first);
  if (differs || (!film->packing && !film->stereo.empty())) {
    notes.push_back(fmt::format("`packing` {} is given, but {} says {}{}", to_name(given), file,
                                film->stereo,
                                film->packing ? fmt::format(": {}", to_name(*film->packing)) : ""));
  } else if (!film->packing && film->tracks == 2) {
    notes.push_back(fmt::format("`packing` {} is given, but {} has two video tracks of one size",
                                to_name(given), file));
  }
}

}  // namespace

std::unique_ptr<PairSource> make_packed_pairs(std::unique_ptr<FrameSource> source,
                                              StereoPacking packing) {
  if (packing.layout == StereoLayout::kFrames) {
    const SuccessiveFrames turns{.step = packing.right_first ? -1 : 1, .distance = 2};
    return make_moving_camera_pairs(std::move(source), turns);
  }
  return std::make_unique<PackedPairs>(std::move(source), packing);
}

std::unique_ptr<FrameSource> open_noted_source(const std::string& spec,
                                               const PhotographReading& reading,
                                               std::vector<std::string>& notes) {
  std::unique_ptr<FrameSource> source = open_frame_source(spec, reading);
  for (std::string& note : source->remarks()) {
    if (std::ranges::find(notes, note) == notes.end()) {
      notes.push_back(std::move(note));
    }
  }
  return source;
}

std::unique_ptr<PairSource> open_stereo_pairs(const PairSourceOptions& options,
                                              std::vector<std::string>& notes) {
  std::unique_ptr<FrameSource> source = open_frame_source(options.stereo, options.reading);
  const FilmProperties* film = source->film();
  if (film != nullptr && !film->further_views.empty()) {
    refuse_further_views(options.stereo, film->further_views);
  }
  if (!options.packing && film == nullptr && is_stereo_jpeg(source->files().front())) {
    return open_views(options);
  }
  const bool is_track = source->video_file() != options.stereo;
  if (!options.packing && !is_track && film != nullptr && film->stereo.empty() &&
      film->tracks == 2) {
    return open_tracks(options, notes);
  }
  const StereoPacking packing =
      options.packing ? *options.packing : packing_of_film(options.stereo, film, notes);
  if (options.packing) {
    note_contradiction(options.stereo, film, packing, notes);
  }
  if (packing.layout == StereoLayout::kRows) {
    if (options.reading.deinterlaces) {
      throw UsageError(
          fmt::format("deinterlace cannot be used with packing {}: the two images are "
                      "the two fields",
                      to_name(packing)));
    }
    source->take_fields_apart();
  }
  const std::vector<std::string> remarks = source->remarks();
  notes.insert(notes.end(), remarks.begin(), remarks.end());
  return make_packed_pairs(std::move(source), packing);
}

std::vector<std::string> NotedPairs::remarks() const {
  std::vector<std::string> remarks = notes_;
  const std::vector<std::string> own = source_->remarks();
  remarks.insert(remarks.end(), own.begin(), own.end());
  return remarks;
}

}  // namespace vantage
