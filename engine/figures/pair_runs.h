#pragma once

#include <functional>
#include <string>
#include <vector>

#include "engine/evaluation/method_comparison.h"
#include "engine/figures/book_figure.h"

namespace vantage {

/// Noise of the book's pairs where a figure shows one level: its text adds noise to ramp, without
/// saying how much, and none to the others. 1 grey level here.
double noise_in_force(double noise_sigma, const std::string& pair);

/// The runs that settings ask for, with `more` parameters; empty when stopped.
std::vector<ComparisonRun> runs_of(const FigureRun& run, const MethodOverrides& more = {});

/// The cell `iterations` of a table; empty for methods that are not iterative.
std::string iterations_field(const std::string& method, int iterations);

/// Whether two runs differ in nothing but iterations.
bool differ_in_iterations(const ComparisonRun& a, const ComparisonRun& b);

/// The columns and rows of a figure's main table.
FigureTable table_of(const std::vector<ComparisonRun>& runs);

/// "1/4" for a quarter: names for readers.
std::string noise_label(double sigma);

/// Share of the pixels of a map for which `holds`, percent.
double percent_where(const DisparityMap& map,
                     const std::function<bool(int x, int y, float disparity)>& holds);

/// The pair as it is in the comparison, in both images.
BookPair pair_of(const FigureSettings& settings, const std::string& pair, double noise_sigma);

}  // namespace vantage
