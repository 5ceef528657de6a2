#pragma once

#include <array>
#include <string>
#include <vector>

#include "engine/figures/book_figure.h"
#include "engine/figures/figure_images.h"
#include "engine/image/disparity_maps.h"
#include "engine/matching/options/match_options.h"
#include "engine/plot/picture_sheet.h"

namespace vantage {

/// Options for photographs: a method of the comparisons and the parameters of the settings.
/// `dense`: refined to dense maps as in 5.6 (edges within 4 pixels, cross-check within 3 of 45
/// disparities, confidence above 0, constant depth), unless the method is a preset, which has its
/// own refinement; else winners only.
MatchOptions scene_options(const FigureSettings& settings, const std::string& method,
                           int iterations, DisparityRange disparities, bool dense);

/// Both maps.
DisparityMaps scene_maps(const FigureImages& images, const MatchOptions& options,
                         Execution& execution);

/// A photograph or map as the cameras saw it.
SheetPicture photograph_picture(const FigureImages& images, std::string title,
                                const Photograph& photograph);
/// The figure that shows two photographs, each `width` drawing units wide.
FigureContent show_pair(BookImages which, const std::string& title,
                        const std::array<const char*, 2>& names, double width,
                        const FigureRun& run);
/// Lighter is nearer; unknown is black.
SheetPicture map_picture(const FigureImages& images, std::string title,
                         ImageView<const float> disparity);

/// The scores as fields of a table: bad ½, bad 1 and bad 2 in percent, RMS in px. Without truth the
/// fields are empty.
std::vector<std::string> score_fields(const FigureImages& images,
                                      ImageView<const float> left_disparity);

}  // namespace vantage
