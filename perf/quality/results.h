#pragma once

#include <optional>
#include <string>
#include <vector>

#include "perf/quality/bad_pixels.h"
#include "perf/quality/map_contender.h"
#include "perf/quality/sub_pixel.h"
#include "perf/quality/true_scenes.h"
#include "perf/stopwatch.h"

namespace vantage::perf {

/// Results of one contender on one scene.
struct Outcome {
  BadPixels bad;
  std::optional<FrameTime> time;  ///< for both maps; empty: not timed
  SubPixelFigures sub_pixel;      ///< for scenes with fractional truth
};

struct Results {
  std::vector<MapContender> contenders;
  std::vector<const TrueScene*> scenes;
  std::vector<std::vector<Outcome>> outcomes;    ///< [contender][scene]
  std::vector<SubPixelFigures> truth_sub_pixel;  ///< [scene], for scenes with fractional truth
};

/// Prints Markdown: means per group and over all scenes, the number of scenes on which our
/// contenders beat all of StereoSGBM's settings, and bad pixels per scene.
void print_tables(const Results& results);

/// Prints Markdown: distribution and accuracy of the fractions of disparities, averaged over each
/// group's scenes with fractional truth.
void print_sub_pixel_tables(const Results& results);

/// One line per contender and scene. Throws Error if the file cannot be written.
void write_csv(const Results& results, const std::string& file);

}  // namespace vantage::perf
