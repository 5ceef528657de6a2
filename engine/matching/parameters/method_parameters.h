#pragma once

#include <type_traits>

#include "engine/option_field.h"

namespace vantage {

/// Named combinations of cost, aggregation and parameters, as the book uses them.
enum class MatchMethod { kSsd, kGradient, kDiffusion, kMembrane, kLocalStopping, kBayes };
/// Combinations for real photographs, chosen by measurement (docs/QUALITY.md).
enum class MatchPreset { kFast, kBalanced, kQuality };

/// What a cell of the disparity space starts from: the dissimilarity of a pixel and its partner.
enum class MatchCost {
  kSquared,           ///< ΔI² (6.2)
  kAbsolute,          ///< |ΔI|
  kTruncated,         ///< min(|ΔI|, truncation)
  kBirchfieldTomasi,  ///< |ΔI| insensitive to sampling: least over half a pixel either way
  kGradient,          ///< −evidence (5.5)
  kContaminated,  ///< −log[(1−ε) exp(−ΔI²/2σ²) + ε], contaminated Gaussian (6.26 ff.)
  kCensus,        ///< Hamming distance of 9×7 census codes
  kRayCensus,     ///< the same of codes with 24 neighbours in eight directions, denser inside
  kCombined,      ///< Σ −log of contaminated Gaussians: grey levels, census, gradients
};
/// How cells gather support from their neighbours.
enum class Aggregation {
  kNone,
  kBox,            ///< square window (Fig. 1.11)
  kGaussian,       ///< sampled Gaussian, radius 4σ
  kBoxCascade,     ///< four box filters of the Gaussian's variance (Wells)
  kDiffusion,      ///< (6.7)
  kMembrane,       ///< (6.9)
  kLocalStopping,  ///< diffusion that stops where it would cost certainty (6.4)
  kBayes,          ///< (6.25)–(6.37)
};
enum class Subpixel { kParabola, kNone };
enum class Border { kValid, kClip };
/// What costs compare of colour images.
enum class ColourUse {
  kLuma,      ///< Rec. 601
  kChannels,  ///< mean of the costs of the channels
};
enum class Certainty {
  kMargin,   ///< winner margin (6.13)
  kEntropy,  ///< negative entropy (6.15)
};
/// Bayes: what the prior makes of what a neighbour says of disparities beside each other (6.35).
enum class PriorSmoothing {
  kSum,      ///< their probabilities, weighed and added up
  kMaximum,  ///< the largest of them: energies that are added and compared, in a third of the time
};
enum class GradientFilter { kCentral, kSobel, kSimoncelli3, kSimoncelli5 };
enum class GradientNorm { kL2, kOctagon };

/// Blocks that a tile can have, see MethodParametersOf::candidate_blocks.
inline constexpr int kMaxCandidateBlocks = 8;

/// Everything that decides how costs are made, aggregated and selected, with the book's defaults of
/// the method ssd. With Field = std::optional: what a user sets; with Field = std::type_identity_t:
/// what is in force. A field stands here and in visit_fields() (options/method_fields.h); what is
/// forgotten there does not compile.
template <template <typename> class Field>
struct MethodParametersOf {
  Field<MatchCost> cost = by_default<Field>(MatchCost::kSquared);
  Field<ColourUse> colour = by_default<Field>(ColourUse::kLuma);
  /// Truncated cost: grey levels, > 0.
  Field<double> truncation = by_default<Field>(20.0);
  /// σM in grey levels, > 0: contaminated and combined cost, Bayes, entropy.
  Field<double> sigma_measurement = by_default<Field>(5.0);
  /// εM, inside (0, 1): contaminated and combined cost, Bayes.
  Field<double> epsilon_measurement = by_default<Field>(0.1);
  /// σM follows from each pair (pair_exposure); where it does not, it is sigma_measurement. Of the
  /// combined cost unless either is set.
  Field<bool> estimate_sigma_measurement = by_default<Field>(false);
  /// The right image's grey levels are changed to the left's before they are compared, gain and
  /// offset estimated from each pair (pair_exposure).
  Field<bool> match_exposure = by_default<Field>(false);
  /// Ray census: grey levels a neighbour is compared with, 1 or 3.
  Field<int> census_thresholds = by_default<Field>(1);
  /// Combined cost: σ of the share of census bits, 0..1; 0: no term.
  Field<double> sigma_census = by_default<Field>(0.2);
  /// Combined cost: σ in grey levels per pixel, ≥ 0; 0: no term.
  Field<double> sigma_gradient = by_default<Field>(0.0);
  /// Gradient evidence: weight of the gradients' difference, ≥ 0.
  Field<double> alpha = by_default<Field>(1.0);
  Field<GradientNorm> norm = by_default<Field>(GradientNorm::kL2);
  Field<GradientFilter> gradient = by_default<Field>(GradientFilter::kCentral);
  /// Gradient evidence: Gaussian σ = ½ first.
  Field<bool> prefilter = by_default<Field>(true);

  Field<Aggregation> aggregation = by_default<Field>(Aggregation::kBox);
  /// Box: side of the square window, odd, 1..181.
  Field<int> window_px = by_default<Field>(9);
  Field<Border> border = by_default<Field>(Border::kClip);  ///< of box aggregation
  /// Gaussian, box cascade: σ, 0.5..16.
  Field<double> aggregation_sigma_px = by_default<Field>(2.0);
  /// Of diffusion, membrane, local stopping, Bayes: 0..10000.
  Field<int> iterations = by_default<Field>(10);
  /// Coarse to fine, 1..10: `iterations` at each level, from an image of 1/2^(levels − 1) of the
  /// size to the image itself; levels that would be a single pixel are left out. 1: flat.
  Field<int> levels = by_default<Field>(1);
  /// Bayes with levels: blocks of 16 candidates that are looked at in each tile of 8×8 pixels of
  /// the finest `pruned_levels` levels, 1..8; 0: all candidates.
  Field<int> candidate_blocks = by_default<Field>(0);
  /// 1..10; the coarsest level always looks at all candidates.
  Field<int> pruned_levels = by_default<Field>(2);
  /// Of the image's own level where there are several: 0..10000. Unless set, `iterations`.
  Field<int> final_iterations = by_default<Field>(10);
  /// Step: 0 < λ < ¼; membrane: λ ≤ 1/(4+β).
  Field<double> lambda = by_default<Field>(0.15);
  /// Membrane: pull towards the first cost, ≥ 0.
  Field<double> beta = by_default<Field>(0.5);
  Field<Certainty> certainty = by_default<Field>(Certainty::kMargin);  ///< local stopping
  /// Bayes: weight of the neighbours, 0 < μ ≤ 1.
  Field<double> mu = by_default<Field>(0.5);
  /// Bayes: σP in pixels of disparity, > 0.
  Field<double> sigma_prior = by_default<Field>(0.4);
  /// Bayes: εP, inside (0, 1).
  Field<double> epsilon_prior = by_default<Field>(0.01);
  /// Bayes: σP of a level ÷ that of the next finer one, 1..4.
  Field<double> prior_growth = by_default<Field>(1.0);
  Field<PriorSmoothing> prior_smoothing = by_default<Field>(PriorSmoothing::kSum);  ///< Bayes
  /// Bayes: energies of a coarse level are this share of the sum of those of 2×2 pixels, which are
  /// not independent of each other; 0 < w ≤ 1.
  Field<double> level_weight = by_default<Field>(1.0);
  /// Bayes: weight of a neighbour beyond the strongest intensity edge, 0..1; 1: edges do not count.
  Field<double> edge_weight = by_default<Field>(1.0);
  /// Bayes: grey levels over which the weight falls, > 0.
  Field<double> edge_contrast = by_default<Field>(8.0);

  Field<Subpixel> subpixel = by_default<Field>(Subpixel::kParabola);

  friend bool operator==(const MethodParametersOf&, const MethodParametersOf&) = default;
};

/// Empty fields take what the preset, then the method says.
using MethodOverrides = MethodParametersOf<OptionalField>;
using MethodParameters = MethodParametersOf<std::type_identity_t>;

/// What is in force on one level, the image's own being 0: iterations and σP.
MethodParameters at_level(const MethodParameters& parameters, int level);

/// Whether the neighbours of a pixel count by the intensity edges between them.
bool uses_edge_weights(const MethodParameters& parameters);

}  // namespace vantage
