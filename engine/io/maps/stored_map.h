#pragma once

#include <string>
#include <vector>

#include "engine/image/image.h"
#include "engine/remark.h"

namespace vantage {

/// The values of a map file as they are stored.
struct StoredMap {
  Image<float> values;       ///< one channel; integers are exact up to 2²⁴
  int integer_bits = 0;      ///< 8 to 64; 0: floats
  bool is_signed = false;    ///< of integers
  double default_scale = 0;  ///< that its format has for integers; 0: none
};

// Values that are not known become NaN: NaN and ±inf of floats, 0 of integers without negative
// values, and what OpenCV's matchers write, (minDisparity − 1) · scale: the least value of
// integers, at least a pixel below the others, if it is −scale, or, at the 1/16 px of these
// matchers, a whole number of pixels while others are not. Unsigned 16-bit values from 32768 on are
// negative numbers that were wrapped if they are 1/16 px, or more than the width of the image. What
// was recognised is one remark. Neither concerns the default scale of a format. `file`: its name in
// remarks and messages. Thread rule: pure.

/// Disparities in pixels: floats as they are, integers divided by `scale`; 0: the default. Throws
/// Error if there is none.
Image<float> disparities_of(StoredMap&& stored, double scale, const std::string& file,
                            std::vector<Remark>* remarks);

/// Depths in metres: values divided by `scale`; 0: 1000 for integers (millimetres), 1 for floats,
/// which is a remark. Depths of 0 and less are unknown.
Image<float> depths_of(StoredMap&& stored, double scale, const std::string& file,
                       std::vector<Remark>* remarks);

}  // namespace vantage
