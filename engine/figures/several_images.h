#pragma once

#include <string>

#include "engine/figures/book_figure.h"
#include "engine/figures/figure_images.h"
#include "engine/image/image.h"

namespace vantage {

/// The left map by multiple-baseline stereo from all images (6.6).
DisparityMap map_of_several(const FigureImages& images, const FigureSettings& settings,
                            const std::string& method, int iterations, DisparityRange disparities,
                            Execution& execution);

/// The parameters of Figs. 6.18 and 6.19: 50 iterations, sigma_P = 0.4, epsilon_P = 0.01, sigma_M =
/// 5, epsilon_M = 0.1.
FigureSettings several_images_settings(BookImages images);

}  // namespace vantage
