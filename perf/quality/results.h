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

/// One contender on one scene.
struct Outcome {
  BadPixels bad;
  std::optional<FrameTime> time;  ///< of both maps; empty: not timed
  SubPixelFigures sub_pixel;      ///< of scenes with fractional truth
};

struct Results {
  std::vector<MapContender> contenders;
  std::vector<const TrueScene*> scenes;
  std::vector<std::vector<Outcome>> outcomes;    ///< [contender][scene]
  std::vector<SubPixelFigures> truth_sub_pixel;  ///< [scene], of fractional truth
};

/// Markdown: means of each group and of all scenes, on how many scenes our contenders beat all of
/// StereoSGBM's settings, and bad pixels by scene.
void print_tables(const Results& results);

/// Markdown: how the fractions of disparities are distributed, and how exact they are, in the mean
/// over the scenes with fractional truth of each group.
void print_sub_pixel_tables(const Results& results);

/// One line for each contender and scene. Throws Error when the file cannot be written.
void write_csv(const Results& results, const std::string& file);

}  // namespace vantage::perf
