#pragma once

#include <optional>
#include <vector>

#include "engine/execution.h"
#include "engine/image/disparity_maps.h"
#include "engine/image/photograph.h"
#include "engine/rectification/rectified_pair.h"
#include "engine/rectification/rectifier.h"
#include "engine/rectification/rows/row_field.h"
#include "engine/remark.h"

namespace vantage {

/// The images as they were read, and how they became rectified ones.
struct UnrectifiedImages {
  Rectifier rectifier;
  Photograph left;
  Photograph right;
};

/// A rectified pair and its maps.
struct PairWithMaps {
  std::optional<UnrectifiedImages> unrectified;  ///< where they had to be rectified
  std::optional<RectifiedPair> cameras;          ///< with a calibration
  Photograph left;
  Photograph right;
  DisparityMaps maps;
};

/// Brings what belongs to `right`, whose rows have been corrected, to its new rows: the photograph
/// as it was read, and the maps where there are some. Identical for any execution.
void follow_corrected_rows(const RowField& field, Execution& execution, PairWithMaps& pair);

/// Brings `right`, and what belongs to it, to the rows of `left`, where the images show how and it
/// pays. Returns by what; none: nothing was changed. Adds what users are told of the rows to
/// `remarks`. `expects_negative`: see RowUse. Identical for any execution. Thread rule: may be
/// called concurrently for different pairs.
std::optional<RowField> correct_pair(bool expects_negative, Execution& execution,
                                     PairWithMaps& pair, std::vector<Remark>& remarks);

}  // namespace vantage
