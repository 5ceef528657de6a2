#pragma once

#include <limits>
#include <type_traits>

#include "engine/option_field.h"

namespace vantage {

/// What unmatched pixels become.
enum class Fill {
  kConstant,  ///< the depth of the background beside them (EQUATIONS §5.4)
  kLinear,    ///< between both sides where their disparities nearly agree, else constant
  kMedian,    ///< constant, then the median of what is around and looks alike (filled_medians)
  kNone,      ///< unknown
};

/// A confidence_threshold that all pixels are above.
inline constexpr double kNoConfidenceThreshold = -std::numeric_limits<double>::infinity();

/// What is done to maps after the winners are chosen (EQUATIONS §5), in this order. With Field =
/// std::optional: what a user sets; with Field = std::type_identity_t: what is in force. A field
/// stands here and in visit_fields() (refinement_fields.h); what is forgotten there does not
/// compile.
template <template <typename> class Field>
struct RefinementOptionsOf {
  /// Moves discontinuities to intensity edges at most this far away; 0: leaves them; 0..16.
  Field<int> edge_snapping_px = by_default<Field>(0);
  Field<bool> cross_check = by_default<Field>(true);
  /// Left and right disparities agree if they differ by less, ≥ 1 (5.13).
  Field<double> cross_check_px = by_default<Field>(1.0);
  /// The level of the other image's map (coarse to fine, Bayesian diffusion) that a map is checked
  /// against: its winners, each standing for all the pixels of the image that it covers. 0: the
  /// map itself. Of fewer levels the coarsest; 0..9. A map that is not asked for is not made any
  /// finer than this.
  Field<int> cross_check_level = by_default<Field>(0);
  /// Pixels with a confidence of at most this are unmatched (5.14), in the unit of the method's
  /// confidence; −infinity: none are.
  Field<double> confidence_threshold = by_default<Field>(kNoConfidenceThreshold);
  /// Matched regions of fewer pixels than this count as unmatched; ≥ 0, 0 and 1: none do.
  Field<int> speckle_size_px = by_default<Field>(0);
  /// Matched pixels take the values of planes through the matched ones at most this far around
  /// (surface_fit); 0: they keep what they have; 0..16.
  Field<int> surface_fit_px = by_default<Field>(0);
  Field<Fill> fill = by_default<Field>(Fill::kConstant);

  friend bool operator==(const RefinementOptionsOf&, const RefinementOptionsOf&) = default;
};

/// Empty fields take what the preset says, then the defaults.
using RefinementOverrides = RefinementOptionsOf<OptionalField>;
using RefinementOptions = RefinementOptionsOf<std::type_identity_t>;

/// Whether refinement looks at the confidence of the maps.
inline bool uses_confidence(const RefinementOptions& refinement) {
  return refinement.confidence_threshold > kNoConfidenceThreshold;
}

}  // namespace vantage
