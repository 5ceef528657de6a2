#pragma once

#include <string>

namespace vantage {

/// Shape of a pixel as it is shown: width to height, as FFmpeg's sample aspect ratio.
struct PixelAspect {
  int width = 1;
  int height = 1;
  friend bool operator==(const PixelAspect&, const PixelAspect&) = default;
};

/// What the colours of a film mean, as it states it. Numbers of ITU-T H.273, which are FFmpeg's
/// (AVCOL_PRI_…, AVCOL_TRC_…, AVCOL_SPC_…).
struct FilmColours {
  static constexpr int kNotStated = 2;

  int primaries = kNotStated;
  int transfer = kNotStated;
  int matrix = kNotStated;
  bool has_full_range = false;
  int bits = 8;  ///< per sample
  /// Of the display it was graded on (SMPTE ST 2086), as x265 writes it:
  /// "G(x,y)B(x,y)R(x,y)WP(x,y)L(max,min)"; empty: not stated.
  std::string mastering_display = {};
  std::string light_level = {};  ///< "MaxCLL,MaxFALL" in cd/m²; empty: not stated

  /// PQ (SMPTE ST 2084) or HLG (ARIB STD-B67).
  [[nodiscard]] bool is_hdr() const { return transfer == 16 || transfer == 18; }
  friend bool operator==(const FilmColours&, const FilmColours&) = default;
};

/// What a film says of its pictures beside their pixels.
struct FilmFormat {
  PixelAspect pixel_aspect;
  FilmColours colours;
  friend bool operator==(const FilmFormat&, const FilmFormat&) = default;
};

}  // namespace vantage
