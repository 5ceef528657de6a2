#pragma once

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
/// Lighter is nearer; unknown is black.
SheetPicture map_picture(const FigureImages& images, std::string title,
                         ImageView<const float> disparity);

/// "3.1 % bad (over 1 px), RMS 0.8 px of the visible pixels with truth"; empty without truth.
std::string score_text(const FigureImages& images, ImageView<const float> left_disparity);
/// The scores as fields of a table: bad ½, bad 1 and bad 2 in percent, RMS in px. Without truth the
/// fields are empty.
std::vector<std::string> score_fields(const FigureImages& images,
                                      ImageView<const float> left_disparity);

}  // namespace vantage
