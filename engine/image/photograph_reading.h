#pragma once

#include <optional>

namespace vantage {

/// How files and films become photographs.
struct PhotographReading {
  /// Turned as the EXIF orientation of a file or the display matrix of a film says; else left as
  /// stored.
  bool turns_upright = true;
  /// Pictures of films are made of both fields by FFmpeg's filter bwdif, where they are flagged as
  /// interlaced; where the film flags none, all.
  bool deinterlaces = false;
  /// Which band is read, counted from 1, where a file has other channels than grey, RGB and alpha.
  /// Empty: see read_photograph().
  std::optional<int> band = {};
  /// Which picture of a file is read, counted from 0: a page of a TIFF, a view of an MPO or JPS.
  /// Empty: the first one, or the whole JPS.
  std::optional<int> page = {};

  friend bool operator==(const PhotographReading&, const PhotographReading&) = default;
};

}  // namespace vantage
