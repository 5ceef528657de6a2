#pragma once

#include <cstddef>

#include "engine/execution.h"
#include "engine/image/image.h"
#include "kernels/view_projection/view_projection.h"

namespace vantage {

/// Forward-maps the disparities of one image into a new view: a z-buffer on nearness q in which
/// sampling gaps of surfaces are filled (kernels/surface_splat). −inf where nothing is mapped.
///
/// `nearness`: of the view's size, rows of fewer than 2³⁰ values. Neighbours whose disparities
/// differ by at most `gradient_limit_px` are one surface. Results are identical for any execution:
/// the maximum of all samples does not depend on their order.
void map_surfaces(ImageView<const float> disparity_px, const kernels::ViewProjection& view,
                  float gradient_limit_px, ImageView<float> nearness, Execution& execution);

/// Working memory of map_surfaces() in bytes, besides rows per thread.
[[nodiscard]] std::size_t surface_map_bytes(int source_width, int source_height);

}  // namespace vantage
