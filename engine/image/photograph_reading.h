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
  /// Of files with other channels than grey, RGB and alpha: the band that is read, counted from 1.
  /// Empty: see read_photograph().
  std::optional<int> band = {};
  /// Of files of several pictures, counted from 0: pages of TIFF, views of MPO and JPS. Empty: the
  /// first page or view; a JPS file whole.
  std::optional<int> page = {};

  friend bool operator==(const PhotographReading&, const PhotographReading&) = default;
};

}  // namespace vantage
