#pragma once

#include <atomic>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/evaluation/disparity_evaluation.h"
#include "engine/execution.h"
#include "engine/generation/book_pairs.h"
#include "engine/image/image.h"
#include "engine/matching/options/match_options.h"

namespace vantage {

/// A method of the comparisons on the book's pairs, with the book's parameters (6.6).
struct ComparedMethod {
  std::string_view name;
  std::string_view description;
  bool is_iterative = true;  ///< takes the iterations of the comparison
  /// Its options for pairs of that pattern, but for range, reference and iterations.
  MatchOptions (*options)(BookPattern pattern);
};

/// The methods of Figs. 6.10, 6.16 and 6.17, then others.
std::span<const ComparedMethod> compared_methods();
/// Throws UsageError that lists the known names.
const ComparedMethod& compared_method(std::string_view name);
/// `method.options(pattern)` with those of `parameters` that the method reads.
MatchOptions compared_options(const ComparedMethod& method, BookPattern pattern, int iterations,
                              const MethodOverrides& parameters);

/// Every pair × noise × method × iterations.
struct ComparisonOptions {
  std::vector<std::string> pairs;      ///< names of kBookPairNames
  std::vector<double> noise_sigmas;    ///< grey levels, 0..255
  std::vector<std::string> methods;    ///< names of compared_methods()
  std::vector<int> iterations = {10};  ///< 0..10000
  int size_px = 100;                   ///< width and height, 16..4096
  std::uint64_t seed = 1;              ///< of textures and noise
  MethodOverrides parameters = {};     ///< each is used by the methods that read it

  /// Throws UsageError naming the field, its value and its limit.
  void validate() const;
};

/// One method on one pair.
struct ComparisonRun {
  std::string pair;
  double noise_sigma = 0;
  std::string method;
  int iterations = 0;  ///< of iterative methods
  /// Errors of the map over the non-occluded pixels of the reference image.
  DisparityScores scores;
  DisparityMap map;  ///< on the grid of the reference image
};

/// The options of a pair in a comparison: real-valued grey levels.
BookPairOptions comparison_pair(const ComparisonOptions& options, std::string_view pair,
                                double noise_sigma);

/// All runs, the last of the four lists varying fastest; one run of methods that are not iterative,
/// whatever the iterations. Empty when `stop` was set before the end.
/// Runs are distributed over the threads; identical for any `execution`. Throws UsageError for
/// invalid options.
std::vector<ComparisonRun> compare_methods(const ComparisonOptions& options, Execution& execution,
                                           const std::atomic<bool>* stop = nullptr);

}  // namespace vantage
