#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/evaluation/disparity_evaluation.h"
#include "engine/execution.h"
#include "engine/generation/book_pairs.h"
#include "engine/image/image.h"

namespace vantage {

/// The algorithms compared in Figs. 6.10, 6.16 and 6.17.
enum class ExperimentMethod {
  kSsd,                   ///< 5×5 windows
  kDiffusion,             ///< (6.7)
  kMembrane,              ///< β = 0.5
  kLocalStoppingMargin,   ///< certainty (6.13)
  kLocalStoppingEntropy,  ///< certainty (6.15)
  kBayes,                 ///< εP .01, σP .1, εM .1, σM depending on the texture
};
std::string_view experiment_method_name(ExperimentMethod method);

/// Standard deviations of the noise, grey levels, and the algorithms of Figs. 6.16 and 6.17.
inline constexpr std::array<double, 8> kExperimentNoise = {0, 0.25, 0.5, 1, 2, 4, 8, 16};
inline constexpr std::array<ExperimentMethod, 4> kNoiseMethods = {
    ExperimentMethod::kSsd, ExperimentMethod::kMembrane, ExperimentMethod::kLocalStoppingMargin,
    ExperimentMethod::kBayes};
/// Iterations and algorithms of Fig. 6.10.
inline constexpr std::array<int, 5> kExperimentIterations = {1, 3, 10, 30, 100};
inline constexpr std::array<ExperimentMethod, 4> kIterationMethods = {
    ExperimentMethod::kDiffusion, ExperimentMethod::kLocalStoppingMargin,
    ExperimentMethod::kLocalStoppingEntropy, ExperimentMethod::kMembrane};

struct BookExperimentOptions {
  std::vector<std::string> pairs = {kBookPairNames.begin(), kBookPairNames.end()};
  int size_px = 100;    ///< width and height, 16..4096
  int iterations = 10;  ///< in the comparison against noise, 0..10000
  std::uint64_t seed = 1;

  /// Throws UsageError naming the field, its value and its limit.
  void validate() const;
};

/// One algorithm on one pair.
struct ExperimentRun {
  std::string pair;
  double noise_sigma = 0;
  ExperimentMethod method = ExperimentMethod::kSsd;
  int iterations = 0;
  /// Errors of the raw map over the non-occluded pixels of the reference image.
  DisparityScores scores;
  DisparityMap map;  ///< on the grid of the reference image
};

/// Callbacks during a series of runs: `on_run` is called after each run, from any thread but never
/// concurrently; setting `stop` prevents further runs from starting.
struct ExperimentWatch {
  std::function<void(int done, int total)> on_run = {};
  const std::atomic<bool>* stop = nullptr;
};

/// All pairs × noise levels × kNoiseMethods, in this order (Figs. 6.16, 6.17). Empty when stopped.
/// Runs are distributed over the threads; identical for any `execution`. Throws UsageError for
/// invalid options.
std::vector<ExperimentRun> run_noise_experiment(const BookExperimentOptions& options,
                                                Execution& execution, const ExperimentWatch& watch);

/// kIterationMethods × kExperimentIterations on the pair ramp-square without noise (Fig. 6.10).
/// `pairs` and `iterations` of the options are ignored. Otherwise as above.
std::vector<ExperimentRun> run_iteration_experiment(const BookExperimentOptions& options,
                                                    Execution& execution,
                                                    const ExperimentWatch& watch);

}  // namespace vantage
