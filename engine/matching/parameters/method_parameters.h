#pragma once

#include <limits>
#include <type_traits>

#include "engine/option_field.h"

namespace vantage {

/// Named combinations of cost, aggregation and parameters, as the book uses them.
enum class MatchMethod { kSsd, kGradient, kDiffusion, kMembrane, kLocalStopping, kBayes };
/// Combinations for real photographs, chosen by measurement (docs/QUALITY.md).
enum class MatchPreset { kRealtime, kBalanced, kQuality };

/// Initial value of a cell of the disparity space: the dissimilarity of a pixel and its partner.
enum class MatchCost {
  kSquared,           ///< ΔI² (6.2)
  kAbsolute,          ///< |ΔI|
  kTruncated,         ///< min(|ΔI|, truncation)
  kBirchfieldTomasi,  ///< |ΔI| insensitive to sampling: minimum within half a pixel
  kGradient,          ///< −evidence (5.5)
  kContaminated,  ///< −log[(1−ε) exp(−ΔI²/2σ²) + ε], contaminated Gaussian (6.26 ff.)
  kCensus,        ///< Hamming distance of 9×7 census codes
  kRayCensus,     ///< Hamming distance of codes with 24 neighbours in 8 directions, denser inside
};
/// How cells gather support from their neighbours.
enum class Aggregation {
  kNone,
  kBox,            ///< square window (Fig. 1.11)
  kGaussian,       ///< sampled Gaussian, radius 4σ
  kBoxCascade,     ///< four box filters of the Gaussian's variance (Wells)
  kDiffusion,      ///< (6.7)
  kMembrane,       ///< (6.9)
  kLocalStopping,  ///< diffusion that stops where certainty would decrease (6.4)
  kBayes,          ///< (6.25)–(6.37)
};
/// How the disparities of a map are selected from aggregated costs.
enum class Selection {
  kWinner,     ///< winner-take-all: each pixel alone
  kScanline,   ///< dynamic programming along each row
  kSymmetric,  ///< dynamic programming along each row of both images: one-to-one or unmatched
};
enum class Subpixel { kParabola, kNone };
enum class Border { kValid, kClip };
/// What costs compare in colour images.
enum class ColourUse {
  kLuma,      ///< Rec. 601
  kChannels,  ///< mean of the costs of the channels
};
enum class Certainty {
  kMargin,   ///< winner margin (6.13)
  kEntropy,  ///< negative entropy (6.15)
};
/// Bayes: what is expected of the disparities of neighbours (6.5.1).
enum class Prior {
  kContaminatedGaussian,  ///< similar, or of another surface (6.19)
  kImpulse,               ///< equal, or of another surface: surfaces are fronto-parallel
  kQuadratic,             ///< similar without exception: a surface without discontinuities
};
/// Bayes: how the prior combines a neighbour's values at adjacent disparities (6.35).
enum class PriorSmoothing {
  kSum,      ///< weighted sum of probabilities
  kMaximum,  ///< largest weighted probability: energies are added and compared, in a third of the
             ///< time
};
/// Size of the images in which all candidates are searched (EQUATIONS §3.13).
enum class SearchSize {
  kFull,
  kHalf,
  kQuarter,
  kAuto,  ///< full for up to 16 candidates, half for up to 128, quarter for more
};
enum class GradientFilter { kCentral, kSobel, kSimoncelli3, kSimoncelli5, kForward };
enum class GradientNorm { kL2, kOctagon, kL1, kMax };
/// Components of the gradients that are compared.
enum class GradientComponents { kXy, kX };

/// Maximum number of blocks per tile, see MethodParametersOf::candidate_blocks.
inline constexpr int kMaxCandidateBlocks = 8;

/// Everything that determines how costs are computed, aggregated and selected, with the book's
/// defaults of the method ssd. Field = std::optional: what a user sets; Field =
/// std::type_identity_t: what is in force. Each field is listed here and in visit_fields()
/// (options/method_fields.h); a field missing there does not compile.
template <template <typename> class Field>
struct MethodParametersOf {
  Field<MatchCost> cost = by_default<Field>(MatchCost::kSquared);
  Field<ColourUse> colour = by_default<Field>(ColourUse::kLuma);
  /// Truncated cost: grey levels, > 0.
  Field<double> truncation = by_default<Field>(20.0);
  /// σM in the cost's unit (grey levels; census codes: differing neighbours), > 0: contaminated
  /// cost, Bayes, entropy.
  Field<double> sigma_measurement = by_default<Field>(5.0);
  /// εM, inside (0, 1): contaminated cost, Bayes.
  Field<double> epsilon_measurement = by_default<Field>(0.1);
  /// Ray census: number of thresholds a neighbour is compared with, 1 or 3.
  Field<int> census_thresholds = by_default<Field>(1);
  /// Gradient evidence: weight of the gradients' difference, ≥ 0.
  Field<double> alpha = by_default<Field>(1.0);
  Field<GradientComponents> gradient_components = by_default<Field>(GradientComponents::kXy);
  /// Gradient evidence with both components.
  Field<GradientNorm> norm = by_default<Field>(GradientNorm::kL2);
  Field<GradientFilter> gradient = by_default<Field>(GradientFilter::kCentral);
  /// Gradient evidence: smooth with a Gaussian of σ = ½ first.
  Field<bool> prefilter = by_default<Field>(true);

  Field<Aggregation> aggregation = by_default<Field>(Aggregation::kBox);
  /// Box: side of the square window, odd, 1..181.
  Field<int> window_px = by_default<Field>(9);
  Field<Border> border = by_default<Field>(Border::kClip);  ///< of box aggregation
  /// Gaussian, box cascade: σ, 0.5..16.
  Field<double> aggregation_sigma_px = by_default<Field>(2.0);
  /// Diffusion, membrane, local stopping, Bayes: 0..10000.
  Field<int> iterations = by_default<Field>(10);
  /// Coarse to fine, 1..10: `iterations` at each level, from an image of 1/2^(levels − 1) of the
  /// size to the image itself; levels of a single pixel are omitted. 1: flat.
  Field<int> levels = by_default<Field>(1);
  /// Size of the images in which `levels` search all candidates. If it is not full, finer levels
  /// search windows of candidates around their result, with final_iterations each; the map has half
  /// the size and is enlarged. Bayes with the prior's maximum, cost kRayCensus with one threshold.
  Field<SearchSize> search_size = by_default<Field>(SearchSize::kFull);
  /// Bayes with levels: blocks of 16 candidates searched in each tile of 8×8 pixels of the finest
  /// `pruned_levels` levels, 1..8; 0: all candidates.
  Field<int> candidate_blocks = by_default<Field>(0);
  /// Number of pruned levels, 1..10; the coarsest level always searches all candidates.
  Field<int> pruned_levels = by_default<Field>(2);
  /// Bayes with levels: 1: the finest level searches windows of candidates around the winners of
  /// the next coarser one. The prior's maximum, cost kRayCensus on luma. Not with several partners.
  Field<int> window_levels = by_default<Field>(0);
  /// Iterations at the finest of several levels: 0..10000. Default: `iterations`.
  Field<int> final_iterations = by_default<Field>(10);
  /// Step size: 0 < λ < ¼; membrane: λ ≤ 1/(4+β).
  Field<double> lambda = by_default<Field>(0.15);
  /// Membrane: pull towards the initial cost, ≥ 0.
  Field<double> beta = by_default<Field>(0.5);
  Field<Certainty> certainty = by_default<Field>(Certainty::kMargin);  ///< local stopping
  /// Bayes: weight of the neighbours, 0 < μ ≤ 1.
  Field<double> mu = by_default<Field>(0.5);
  Field<Prior> prior = by_default<Field>(Prior::kContaminatedGaussian);  ///< Bayes
  /// Bayes, not prior kImpulse: σP in pixels of disparity, > 0.
  Field<double> sigma_prior = by_default<Field>(0.4);
  /// Bayes, not prior kQuadratic: εP, inside (0, 1).
  Field<double> epsilon_prior = by_default<Field>(0.01);
  /// Bayes: ratio of a level's σP to that of the next finer level, 1..4.
  Field<double> prior_growth = by_default<Field>(1.0);
  Field<PriorSmoothing> prior_smoothing = by_default<Field>(PriorSmoothing::kSum);  ///< Bayes
  /// Bayes: weight of the summed energies of 2×2 pixels, which are not independent, as the energy
  /// of one pixel of the next coarser level; 0 < w ≤ 1.
  Field<double> level_weight = by_default<Field>(1.0);
  /// Bayes: from level 2 on, a disparity may take the energy of one a pixel beside it at this many
  /// nats, ≥ 0, because parts of a slanted block differ; infinite: blocks face the cameras.
  Field<double> slant_penalty = by_default<Field>(std::numeric_limits<double>::infinity());
  /// Diffusions and Bayes: weight of a neighbour across the strongest intensity edge, 0..1; 1:
  /// edges are ignored.
  Field<double> edge_weight = by_default<Field>(1.0);
  /// Diffusions and Bayes: intensity difference over which the weight falls, grey levels, > 0.
  Field<double> edge_contrast = by_default<Field>(8.0);
  /// Diffusions and Bayes: iteration n weights neighbours by the intensities after min(n, this)
  /// steps of anisotropic diffusion, 0..1000.
  Field<int> edge_diffusion = by_default<Field>(0);

  Field<Selection> selection = by_default<Field>(Selection::kWinner);
  /// Scanline: maximum cost of a change of disparity between neighbours in a row, in the unit of
  /// the aggregated costs, ≥ 0; infinite: none. Default: by cost and aggregation.
  Field<double> jump_limit = by_default<Field>(200.0);
  /// Scanline: cost of a change per pixel of disparity, ≥ 0. Default: a quarter of the limit.
  Field<double> jump_penalty = by_default<Field>(50.0);
  /// Distance of neighbouring candidates in pixels of disparity: 1, 0.5 or 0.25.
  Field<double> candidate_step_px = by_default<Field>(1.0);
  /// Symmetric: cost of a pixel without a match, in the unit of the aggregated costs, > 0. Default:
  /// by cost and aggregation.
  Field<double> occlusion_penalty = by_default<Field>(100.0);
  Field<Subpixel> subpixel = by_default<Field>(Subpixel::kParabola);

  friend bool operator==(const MethodParametersOf&, const MethodParametersOf&) = default;
};

/// Empty fields take the preset's value, else the method's.
using MethodOverrides = MethodParametersOf<OptionalField>;
using MethodParameters = MethodParametersOf<std::type_identity_t>;

/// The parameters in force on one level, 0 being the finest, as stages use them: iterations and σP
/// differ, σP is in candidates.
MethodParameters at_level(const MethodParameters& parameters, int level);

/// Candidates per pixel of disparity.
int steps_per_px(const MethodParameters& parameters);
/// Difference of disparities in pixels that counts as one that can be told apart unless another is
/// given (EQUATIONS §5.10).
double disparity_resolution_px(const MethodParameters& parameters);

/// Whether the neighbours of a pixel are weighted by the intensity edges between them.
bool uses_edge_weights(const MethodParameters& parameters);

}  // namespace vantage
