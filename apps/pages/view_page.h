#pragma once

#include <array>
#include <string>

#include "apps/inputs/pair_input.h"
#include "engine/execution.h"
#include "engine/synthesis/synthesis_options.h"

namespace vantage::apps {

/// Image format of the photographs in a page.
enum class PageImages {
  kPng,  ///< lossless, 8 bits per channel
  kJpeg  ///< a fraction of the size
};

/// Range of a coordinate of the view, in baselines.
struct ViewRange {
  double first = 0;
  double last = 0;
};

struct ViewPageOptions {
  ViewRange range_x{-0.5, 1.5};  ///< XS: 0 = left camera, 1 = right camera
  ViewRange range_y{-0.2, 0.2};  ///< YS: below the baseline where positive
  PageImages images = PageImages::kPng;
  /// Only holes, gamma, disparity_gradient_limit_px and match_intensities are used.
  SynthesisOptions synthesis;

  /// Throws UsageError naming the option, its value and its limit.
  void validate() const;
};

/// How the page stores disparities: as whole numbers 1..65535, 0 = unknown.
struct DisparityNumbers {
  double smallest_px = 0;  ///< of the number 1; a multiple of step_px
  double step_px = 1;      ///< a power of two
};

/// The finest step in which all known values of both maps can be stored. Throws Error when that is
/// coarser than 1/16 pixel, which is the case when they span more than 4095 pixels.
DisparityNumbers choose_disparity_numbers(ImageView<const float> left,
                                          ImageView<const float> right);

/// An HTML page that renders views of the pair by itself, with everything it needs inside. `names`
/// is what it says it shows. Photographs become 8-bit and lose an alpha channel. Intensities are
/// regressed once, half-way between the cameras, so that brightness does not change on the way.
/// Throws Error when the shapes differ, a side has more than 16384 pixels, or disparities cannot be
/// stored; UsageError for invalid options.
std::string make_view_page(const PairWithMaps& pair, const std::string& names,
                           const ViewPageOptions& options, Execution& execution);

}  // namespace vantage::apps
