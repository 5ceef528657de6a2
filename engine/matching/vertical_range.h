#pragma once

#include <optional>

#include "engine/execution.h"
#include "engine/image/disparity_range.h"
#include "engine/image/photograph.h"

namespace vantage {

/// The range of vertical disparities y_left − y_right to search in a pair whose rows do not
/// correspond: that of the points which both images show (features that are each other's nearest),
/// but for few that stand apart, and half a pixel, so that positions between whole pixels have
/// neighbours. Where they spread over more rows than columns, as of cameras one above the other, it
/// also holds what find_disparity_range() says of the transposed images: small surfaces have few
/// such points. None where the images have too few points in common.
///
/// Images with a side beyond 640 pixels are reduced. Throws Error when sizes differ. Identical for
/// any `execution`. Thread rule: may be called concurrently.
std::optional<DisparityRange> find_vertical_range(const Photograph& left, const Photograph& right,
                                                  Execution& execution);

}  // namespace vantage
