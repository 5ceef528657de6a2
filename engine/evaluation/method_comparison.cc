#include "engine/evaluation/method_comparison.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "engine/error.h"
#include "engine/matching/options/method_fields.h"
#include "engine/matching/stereo_matcher.h"
#include "engine/quoted_text.h"

namespace vantage {
namespace {

constexpr int kMinSizePx = 16;
constexpr int kMaxSizePx = 4096;
constexpr int kMaxIterations = 10000;

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

MatchOptions winners_of(MatchMethod method) {
  MatchOptions options;
  options.method = method;
  options.raw = true;
  options.parameters.subpixel = Subpixel::kNone;
  return options;
}

MatchOptions ssd(BookPattern /*pattern*/) {
  MatchOptions options = winners_of(MatchMethod::kSsd);
  options.parameters.window_px = 5;
  return options;
}

MatchOptions diffusion(BookPattern /*pattern*/) { return winners_of(MatchMethod::kDiffusion); }

MatchOptions membrane(BookPattern /*pattern*/) {
  MatchOptions options = winners_of(MatchMethod::kMembrane);
  options.parameters.beta = 0.5;
  return options;
}

MatchOptions local_stopping_margin(BookPattern /*pattern*/) {
  MatchOptions options = winners_of(MatchMethod::kLocalStopping);
  options.parameters.certainty = Certainty::kMargin;
  return options;
}

MatchOptions local_stopping_entropy(BookPattern pattern) {
  MatchOptions options = winners_of(MatchMethod::kLocalStopping);
  options.parameters.certainty = Certainty::kEntropy;
  options.parameters.sigma_measurement = signal_of(pattern);
  return options;
}

MatchOptions bayes(BookPattern pattern) {
  MatchOptions options = winners_of(MatchMethod::kBayes);
  options.parameters.sigma_prior = 0.1;
  options.parameters.epsilon_prior = 0.01;
  options.parameters.epsilon_measurement = 0.1;
  options.parameters.sigma_measurement = signal_of(pattern);
  return options;
}

MatchOptions gradient(BookPattern /*pattern*/) { return winners_of(MatchMethod::kGradient); }

MatchOptions balanced(BookPattern /*pattern*/) {
  MatchOptions options;
  options.preset = MatchPreset::kBalanced;
  return options;
}

constexpr std::array kMethods = {
    ComparedMethod{"ssd", "squared differences in windows of 5x5", false, ssd},
    ComparedMethod{"diffusion", "regular diffusion (6.7)", true, diffusion},
    ComparedMethod{"membrane", "membrane (6.9), beta = 0.5", true, membrane},
    ComparedMethod{"local-stopping-margin", "local stopping, winner margin (6.13)", true,
                   local_stopping_margin},
    ComparedMethod{"local-stopping-entropy", "local stopping, entropy (6.15)", true,
                   local_stopping_entropy},
    ComparedMethod{"bayes", "the probabilistic model, sigma_M = 2, 8, 20 for ramp, grass, dots",
                   true, bayes},
    ComparedMethod{"gradient", "gradient evidence (chapter 5)", false, gradient},
    ComparedMethod{"balanced", "the default preset with its refinement", false, balanced}};

Mask visible_pixels(const Mask& occluded) {
  Mask visible(occluded.width(), occluded.height());
  for (int y = 0; y < visible.height(); ++y) {
    for (int x = 0; x < visible.width(); ++x) {
      visible.at(x, y) = occluded.at(x, y) == 0 ? 255 : 0;
    }
  }
  return visible;
}

void compute(const ComparisonOptions& options, Execution& execution, ComparisonRun& run) {
  const BookPairOptions pair_options = comparison_pair(options, run.pair, run.noise_sigma);
  const BookPair pair = make_book_pair(pair_options);
  MatchOptions match = compared_options(compared_method(run.method), pair_options.pattern,
                                        run.iterations, options.parameters);
  match.disparities = pair.search;
  match.reference = pair_options.reference;

  const bool left = pair_options.reference == Side::kLeft;
  const StereoMatcher matcher(match, execution);
  DisparityMaps maps;
  matcher.match(pair.left, pair.right, {.left = left, .right = !left, .unmatched = false}, maps);
  run.map = std::move(left ? maps.left.disparity_px : maps.right.disparity_px);
  const Mask visible = visible_pixels(left ? pair.left_occluded : pair.right_occluded);
  const DisparityMap& truth = left ? pair.left_disparity : pair.right_disparity;
  run.scores = evaluate_disparity(run.map.view(), truth.view(), {.mask = visible.view()});
}

template <typename T>
void require_some(const std::vector<T>& list, const char* name) {
  if (list.empty()) {
    throw UsageError(fmt::format("{} is empty, expected at least one value", name));
  }
}

}  // namespace

std::span<const ComparedMethod> compared_methods() { return kMethods; }

const ComparedMethod& compared_method(std::string_view name) {
  const auto found = std::ranges::find(kMethods, name, &ComparedMethod::name);
  if (found == kMethods.end()) {
    std::vector<std::string_view> names;
    for (const ComparedMethod& method : kMethods) {
      names.push_back(method.name);
    }
    throw UsageError(fmt::format("method '{}' is unknown, expected one of {}", quotable(name),
                                 fmt::join(names, ", ")));
  }
  return *found;
}

MatchOptions compared_options(const ComparedMethod& method, BookPattern pattern, int iterations,
                              const MethodOverrides& parameters) {
  MatchOptions options = method.options(pattern);
  if (method.is_iterative) {
    options.parameters.iterations = iterations;
  }
  MatchOptions with_all = options;
  take_over(parameters, with_all.parameters);
  const MethodParameters in_force = with_all.resolved();
  visit_fields(
      [&in_force](const MethodField& field, const auto& wanted, auto& value) {
        if (!field.is_read(in_force)) {
          value.reset();
        } else if (wanted) {
          value = wanted;
        }
      },
      parameters, options.parameters);
  return options;
}

void ComparisonOptions::validate() const {
  require_some(pairs, "pairs");
  require_some(noise_sigmas, "noise");
  require_some(methods, "methods");
  require_some(iterations, "iterations");
  for (const std::string& pair : pairs) {
    book_pair_options(pair);  // throws for unknown names
  }
  for (const double sigma : noise_sigmas) {
    if (!(sigma >= 0 && sigma <= 255)) {
      throw UsageError(fmt::format("noise is {}, expected 0 to 255", sigma));
    }
  }
  for (const std::string& method : methods) {
    compared_method(method);
  }
  for (const int count : iterations) {
    if (count < 0 || count > kMaxIterations) {
      throw UsageError(fmt::format("iterations is {}, expected 0 to {}", count, kMaxIterations));
    }
  }
  if (size_px < kMinSizePx || size_px > kMaxSizePx) {
    throw UsageError(fmt::format("size is {}, expected {} to {}", size_px, kMinSizePx, kMaxSizePx));
  }
}

BookPairOptions comparison_pair(const ComparisonOptions& options, std::string_view pair,
                                double noise_sigma) {
  BookPairOptions pair_options = book_pair_options(pair);
  pair_options.width_px = options.size_px;
  pair_options.height_px = options.size_px;
  pair_options.noise_sigma = noise_sigma;
  pair_options.float_pixels = true;
  pair_options.seed = options.seed;
  return pair_options;
}

std::vector<ComparisonRun> compare_methods(const ComparisonOptions& options, Execution& execution,
                                           const std::atomic<bool>* stop) {
  options.validate();
  std::vector<ComparisonRun> runs;
  for (const std::string& pair : options.pairs) {
    for (const double noise : options.noise_sigmas) {
      for (const std::string& method : options.methods) {
        const bool is_iterative = compared_method(method).is_iterative;
        for (const int iterations : is_iterative ? options.iterations : std::vector{0}) {
          runs.push_back({.pair = pair,
                          .noise_sigma = noise,
                          .method = method,
                          .iterations = iterations,
                          .scores = {},
                          .map = {}});
        }
      }
    }
  }
  std::atomic<bool> is_stopped = false;
  execution.executor().parallel_for(static_cast<int>(runs.size()), [&](int index) {
    if (stop != nullptr && stop->load()) {
      is_stopped = true;
      return;
    }
    compute(options, execution, runs[static_cast<std::size_t>(index)]);
  });
  if (is_stopped) {
    runs.clear();
  }
  return runs;
}

}  // namespace vantage
