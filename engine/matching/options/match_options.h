#pragma once

#include <optional>
#include <string>
#include <type_traits>

#include "engine/matching/options/method_parameters.h"

namespace vantage {

/// Signed, inclusive range of candidate disparities in pixels, d = x_left − x_right.
struct DisparityRange {
  int min = 0;
  int max = 63;
  [[nodiscard]] int count() const { return max - min + 1; }
  friend bool operator==(DisparityRange, DisparityRange) = default;
};

/// Which image's grid the primary map is on.
enum class Reference { kLeft, kRight };
/// What unmatched pixels become.
enum class Fill {
  kConstant,  ///< the depth of the background beside them (EQUATIONS §5.4)
  kLinear,    ///< between both sides where their disparities nearly agree, else constant
  kMedian,    ///< constant, then the median of what is around and looks alike (filled_medians)
  kNone,      ///< unknown
};

/// What is done to maps after the winners are chosen (EQUATIONS §5), in this order. With Field =
/// std::optional: what a user sets; with Field = std::type_identity_t: what is in force.
template <template <typename> class Field>
struct RefinementOptionsOf {
  /// Moves discontinuities to intensity edges at most this far away; 0: leaves them; 0..16.
  Field<int> edge_snapping_px;
  Field<bool> cross_check;
  /// Left and right disparities agree if they differ by less, ≥ 1 (5.13).
  Field<double> cross_check_px;
  /// The level of the other image's map (coarse to fine, Bayesian diffusion) that a map is checked
  /// against: its winners, each standing for all the pixels of the image that it covers. 0: the
  /// map itself. Of fewer levels the coarsest; 0..9. A map that is not asked for is not made any
  /// finer than this.
  Field<int> cross_check_level;
  /// Pixels with a confidence of at most this are unmatched (5.14), in the unit of the method's
  /// confidence; −infinity: none are.
  Field<double> confidence_threshold;
  /// Matched regions of fewer pixels than this count as unmatched; ≥ 0, 0 and 1: none do.
  Field<int> speckle_size_px;
  /// Matched pixels take the values of planes through the matched ones at most this far around
  /// (surface_fit); 0: they keep what they have; 0..16.
  Field<int> surface_fit_px;
  Field<Fill> fill;

  friend bool operator==(const RefinementOptionsOf&, const RefinementOptionsOf&) = default;
};

/// Empty fields take what the preset says, then the defaults.
using RefinementOverrides = RefinementOptionsOf<OptionalField>;
using RefinementOptions = RefinementOptionsOf<std::type_identity_t>;

/// Whether refinement looks at the confidence of the maps.
bool uses_confidence(const RefinementOptions& refinement);

/// Whether maps of these parameters have levels whose winners a cross-check can look at.
bool can_check_levels(const MethodParameters& parameters);

/// Everything that decides what a pair's disparity maps are. Defaults are the command line's.
struct MatchOptions {
  /// Empty: that of the preset in force. Not both.
  std::optional<MatchMethod> method;
  /// Chooses the method and the defaults of everything that is not set.
  std::optional<MatchPreset> preset;
  /// At most 4096 candidates; of a two-dimensional search the pairs of both components count.
  DisparityRange disparities;
  /// `disparities` is still to be replaced by what estimate_disparity_range() says: whoever reads
  /// the images does that. Matchers refuse it.
  bool disparities_auto = false;
  /// Vertical component of a two-dimensional search, y_left − y_right (5.5.3); empty: 0 only.
  std::optional<DisparityRange> disparities_y;
  MethodOverrides parameters;
  Reference reference = Reference::kLeft;
  /// Winner-take-all only: no refinement (sub-pixel stays as set above).
  bool raw = false;
  RefinementOverrides refinement;

  /// Without method and preset it is `balanced`, whatever the cost. None with an aggregation, which
  /// starts from SSD: most of a preset is about its own. None with `disparities_y`, whose columns
  /// are long.
  [[nodiscard]] std::optional<MatchPreset> preset_in_force() const;
  /// What maps are made by, in words: "preset balanced", "method ssd with aggregation gaussian",
  /// "preset balanced with cost census".
  [[nodiscard]] std::string chosen() const;
  /// What is in force: the fields of `parameters`, else the preset's, else the method's.
  [[nodiscard]] MethodParameters resolved() const;
  /// What is in force unless `raw`: the fields of `refinement`, else the preset's, else: no
  /// snapping, a cross-check of whole maps within max(1, D/15) px, a confidence above 0 for
  /// gradient evidence and any for the others, speckles kept, no surface fit, fill at constant
  /// depth.
  [[nodiscard]] RefinementOptions resolved_refinement() const;
  /// The same options with every field set to what is in force, without the preset. To be shown:
  /// validate() refuses them, as a method reads some of the fields only.
  [[nodiscard]] MatchOptions spelled_out() const;
  /// Throws UsageError naming the field, its value and its limit, or why options do not go
  /// together, or which field of `parameters` or `refinement` is set although nothing reads it
  /// (parameter_readers).
  void validate() const;
};

}  // namespace vantage
