#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/image/orientation.h"
#include "engine/remark.h"

namespace vantage {

/// How a lossy codec rounded the pictures that it stored.
struct LossyCoding {
  std::string codec;  ///< "JPEG", or FFmpeg's name: "h264", "mpeg2video", "hevc"
  /// Mean step of the transform's low frequencies in grey levels (0..255), as the codec states it,
  /// for an orthonormal transform: a step q is an error of at most q² / 12 per pixel in the mean
  /// square. JPEG: mean of the five lowest frequencies but the constant one, of luminance. H.264,
  /// MPEG, VP9: from the mean QP of the picture. 0: not stated (HEVC, AV1 and others).
  double step_grey_levels = 0;
  int block_px = 8;  ///< side of its smallest blocks
};

/// What the file or stream of a photograph says about its values. Copies of a photograph and what
/// is resampled from it keep it.
struct PhotographOrigin {
  /// The value that is white in the unit of the pixels, where the file states it; the type's 255,
  /// 65535 or 1 once a photograph was scaled to that.
  std::optional<double> white_level = {};
  std::optional<LossyCoding> coding = {};  ///< empty: lossless, or not known
  /// How its pixels were turned when it was read.
  Orientation turn = Orientation::kAsStored;
  std::vector<Remark> remarks = {};  ///< what its reader assumed
};

}  // namespace vantage
