#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/image/orientation.h"
#include "engine/image/side.h"
#include "engine/image/stereo_packing.h"

namespace vantage {

/// What a video says of its pictures, in its container or, in its first frame, in its bitstream.
struct FilmProperties {
  /// Where both images are. Files do not say whether each has half its size: that is told by the
  /// shape of the pictures.
  std::optional<StereoPacking> packing;
  /// What the file says and where, for messages: "top-bottom, right first (StereoMode)"; empty:
  /// nothing.
  std::string stereo = {};
  /// The image that this track alone holds.
  std::optional<Side> side;
  /// "MV-HEVC" or "MVC": a second view, which this FFmpeg does not decode; else empty.
  std::string_view further_views = {};
  Orientation turn = Orientation::kAsStored;
  bool turns_askew = false;  ///< by the display matrix, which is ignored then
  bool is_interlaced = false;
  bool has_interlaced_flags = false;  ///< in its first frame
  bool upper_field_first = true;
  int width_px = 0;  ///< as stored
  int height_px = 0;
  int track = 0;   ///< its number among the videos of the file
  int tracks = 1;  ///< videos of the same size in the file
};

/// `track`: a number, or kMainVideo. Decodes the first frame; one that is damaged says nothing.
/// Throws Error as VideoDecoder does.
FilmProperties examine_film(const std::filesystem::path& path, int track);

}  // namespace vantage
