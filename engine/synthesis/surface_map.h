#pragma once

#include <cstddef>

#include "engine/execution.h"
#include "engine/image/image.h"
#include "kernels/view_projection/view_projection.h"

namespace vantage {

/// Forward-maps the disparities of one image into a new view: a z-buffer on nearness q with the
/// sampling gaps of surfaces filled (kernels/surface_splat says what lands where). −inf where
/// nothing lands.
///
/// `nearness`: of the view's size, rows of fewer than 2³⁰ values. Neighbours whose disparities
/// differ by at most `gradient_limit_px` are one surface. Results are identical for any execution:
/// the largest of all samples stays, whatever their order.
void map_surfaces(ImageView<const float> disparity_px, const kernels::ViewProjection& view,
                  float gradient_limit_px, ImageView<float> nearness, Execution& execution);

/// Memory that map_surfaces() works in, beside rows per thread.
[[nodiscard]] std::size_t surface_map_bytes(int source_width, int source_height);

}  // namespace vantage
