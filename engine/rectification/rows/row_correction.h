#pragma once

#include "engine/execution.h"
#include "engine/image/disparity_maps.h"
#include "engine/image/photograph.h"
#include "engine/rectification/rectifier.h"
#include "engine/rectification/rows/row_field.h"

namespace vantage {

/// What is done about rows that do not correspond.
enum class RowMode {
  kAuto,  ///< the right image is resampled where the pair itself says how, and it pays
  kAsIs
};

// The right image of a pair on the rows of the left one. The left image, its maps and all depths in
// its pixels stay as they are, and disparities are differences of columns as before. All functions
// are identical for any `execution`. Thread rule: may be called concurrently for different results.

/// result(x, y) = right(x, y + v(x, y)), by bicubic interpolation (Keys, a = −½); rows beyond the
/// border repeat the last one. `result` gets depth, channels and origin of `right`, and reuses its
/// memory; it must not be `right`. Both must have the size of `field`.
void correct_rows(const Photograph& right, const RowField& field, Photograph& result,
                  Execution& execution);

/// The photograph whose rectified image is what correct_rows() makes of that of `right`, so that
/// views can take its colours. As correct_rows(); 0 where the camera of the rectified image sees
/// nothing.
void correct_photograph(const Photograph& right, const RowField& field, const Rectifier& rectifier,
                        Photograph& result, Execution& execution);

/// Maps of the corrected right image on the pixels of the given one: every pixel has the values of
/// the nearest row, also beyond the border. Empty maps stay empty.
void bring_to_given_rows(const RowField& field, MatchedMap& map, Execution& execution);
/// The reverse.
void bring_to_corrected_rows(const RowField& field, MatchedMap& map, Execution& execution);

}  // namespace vantage
