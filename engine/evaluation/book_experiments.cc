#include "engine/evaluation/book_experiments.h"

#include <fmt/format.h>

#include <mutex>

#include "engine/error.h"
#include "engine/matching/stereo_matcher.h"

namespace vantage {
namespace {

constexpr int kMinSizePx = 16;
constexpr int kMaxSizePx = 4096;
constexpr int kMaxIterations = 10000;
constexpr std::string_view kIterationPair = "ramp-square";

/// The strength of the texture's signal (6.6).
double signal_of(BookPattern pattern) {
  switch (pattern) {
    case BookPattern::kRamp:
      return 2;
    case BookPattern::kGrass:
      return 8;
    case BookPattern::kRandomDots:
      break;
  }
  return 20;
}

MatchMethod match_method(ExperimentMethod method) {
  switch (method) {
    case ExperimentMethod::kSsd:
      return MatchMethod::kSsd;
    case ExperimentMethod::kDiffusion:
      return MatchMethod::kDiffusion;
    case ExperimentMethod::kMembrane:
      return MatchMethod::kMembrane;
    case ExperimentMethod::kLocalStoppingMargin:
    case ExperimentMethod::kLocalStoppingEntropy:
      return MatchMethod::kLocalStopping;
    case ExperimentMethod::kBayes:
      break;
  }
  return MatchMethod::kBayes;
}

MatchOptions match_options(const ExperimentRun& run, const BookPairOptions& pair,
                           DisparityRange search) {
  MatchOptions options;
  options.method = match_method(run.method);
  options.disparities = search;
  options.reference = pair.reference;
  options.raw = true;
  MethodOverrides& parameters = options.parameters;
  parameters.subpixel = Subpixel::kNone;
  switch (run.method) {
    case ExperimentMethod::kSsd:
      parameters.window_px = 5;
      return options;
    case ExperimentMethod::kLocalStoppingMargin:
      parameters.certainty = Certainty::kMargin;
      break;
    case ExperimentMethod::kLocalStoppingEntropy:
      parameters.certainty = Certainty::kEntropy;
      parameters.sigma_measurement = signal_of(pair.pattern);
      break;
    case ExperimentMethod::kMembrane:
      parameters.beta = 0.5;
      break;
    case ExperimentMethod::kBayes:
      parameters.sigma_prior = 0.1;
      parameters.epsilon_prior = 0.01;
      parameters.epsilon_measurement = 0.1;
      parameters.sigma_measurement = signal_of(pair.pattern);
      break;
    case ExperimentMethod::kDiffusion:
      break;
  }
  parameters.iterations = run.iterations;
  return options;
}

Mask visible_pixels(const Mask& occluded) {
  Mask visible(occluded.width(), occluded.height());
  for (int y = 0; y < visible.height(); ++y) {
    for (int x = 0; x < visible.width(); ++x) {
      visible.at(x, y) = occluded.at(x, y) == 0 ? 255 : 0;
    }
  }
  return visible;
}

void compute(const BookExperimentOptions& options, Execution& execution, ExperimentRun& run) {
  BookPairOptions pair_options = book_pair_options(run.pair);
  pair_options.width_px = options.size_px;
  pair_options.height_px = options.size_px;
  pair_options.noise_sigma = run.noise_sigma;
  pair_options.float_pixels = true;
  pair_options.seed = options.seed;
  const BookPair pair = make_book_pair(pair_options);

  const bool left = pair_options.reference == Side::kLeft;
  const StereoMatcher matcher(match_options(run, pair_options, pair.search), execution);
  DisparityMaps maps;
  matcher.match(pair.left, pair.right, {.left = left, .right = !left, .unmatched = false}, maps);
  run.map = std::move(left ? maps.left.disparity_px : maps.right.disparity_px);
  const Mask visible = visible_pixels(left ? pair.left_occluded : pair.right_occluded);
  const DisparityMap& truth = left ? pair.left_disparity : pair.right_disparity;
  run.scores = evaluate_disparity(run.map.view(), truth.view(), {.mask = visible.view()});
}

std::vector<ExperimentRun> compute_all(const BookExperimentOptions& options, Execution& execution,
                                       const ExperimentWatch& watch,
                                       std::vector<ExperimentRun> runs) {
  std::mutex mutex;
  int done = 0;
  const int total = static_cast<int>(runs.size());
  const auto stopped = [&] { return watch.stop != nullptr && watch.stop->load(); };
  execution.executor().parallel_for(total, [&](int index) {
    if (stopped()) {
      return;
    }
    compute(options, execution, runs[static_cast<std::size_t>(index)]);
    const std::lock_guard lock(mutex);
    ++done;
    if (watch.on_run) {
      watch.on_run(done, total);
    }
  });
  if (done < total) {
    runs.clear();
  }
  return runs;
}

}  // namespace

std::string_view experiment_method_name(ExperimentMethod method) {
  switch (method) {
    case ExperimentMethod::kSsd:
      return "ssd";
    case ExperimentMethod::kDiffusion:
      return "diffusion";
    case ExperimentMethod::kMembrane:
      return "membrane";
    case ExperimentMethod::kLocalStoppingMargin:
      return "local-stopping-margin";
    case ExperimentMethod::kLocalStoppingEntropy:
      return "local-stopping-entropy";
    case ExperimentMethod::kBayes:
      break;
  }
  return "bayes";
}

void BookExperimentOptions::validate() const {
  if (pairs.empty()) {
    throw UsageError("pairs is empty, expected at least one name");
  }
  for (const std::string& pair : pairs) {
    book_pair_options(pair);  // throws for unknown names
  }
  if (size_px < kMinSizePx || size_px > kMaxSizePx) {
    throw UsageError(fmt::format("size is {}, expected {} to {}", size_px, kMinSizePx, kMaxSizePx));
  }
  if (iterations < 0 || iterations > kMaxIterations) {
    throw UsageError(fmt::format("iterations is {}, expected 0 to {}", iterations, kMaxIterations));
  }
}

std::vector<ExperimentRun> run_noise_experiment(const BookExperimentOptions& options,
                                                Execution& execution,
                                                const ExperimentWatch& watch) {
  options.validate();
  std::vector<ExperimentRun> runs;
  for (const std::string& pair : options.pairs) {
    for (const double noise : kExperimentNoise) {
      for (const ExperimentMethod method : kNoiseMethods) {
        runs.push_back({.pair = pair,
                        .noise_sigma = noise,
                        .method = method,
                        .iterations = options.iterations,
                        .scores = {},
                        .map = {}});
      }
    }
  }
  return compute_all(options, execution, watch, std::move(runs));
}

std::vector<ExperimentRun> run_iteration_experiment(const BookExperimentOptions& options,
                                                    Execution& execution,
                                                    const ExperimentWatch& watch) {
  options.validate();
  std::vector<ExperimentRun> runs;
  for (const ExperimentMethod method : kIterationMethods) {
    for (const int iterations : kExperimentIterations) {
      runs.push_back({.pair = std::string(kIterationPair),
                      .noise_sigma = 0,
                      .method = method,
                      .iterations = iterations,
                      .scores = {},
                      .map = {}});
    }
  }
  return compute_all(options, execution, watch, std::move(runs));
}

}  // namespace vantage
