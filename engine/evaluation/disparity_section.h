#pragma once

#include <cstdint>

#include "engine/image/disparity_range.h"
#include "engine/image/image.h"
#include "engine/image/volume_sink.h"

namespace vantage {

/// A section y = const through a disparity space (Fig. 6.7).
struct DisparitySection {
  DisparityRange disparities;  ///< searched ones that some pixel can have
  int steps_per_px = 1;        ///< candidates per pixel
  VolumeContent content = VolumeContent::kEnergies;
  /// Columns of the image × candidates, the smallest disparity in row 0; NaN where a candidate has
  /// no partner or was not searched.
  Image<float> values;
};

/// The value below which `share` (0..1) of the known values of a section lie.
float section_quantile(const DisparitySection& section, double share);

/// The section as the book shows it: disparities upward, likely cells dark, values linear from
/// `dark` to `light` (which differ) and cut there, unknown cells white. Grey, 8 bits.
Image<std::uint8_t> section_picture(const DisparitySection& section, float dark, float light);

}  // namespace vantage
