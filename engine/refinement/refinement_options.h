#pragma once

#include <cmath>
#include <concepts>
#include <limits>
#include <string_view>
#include <type_traits>

#include "engine/option_field.h"

namespace vantage {

/// How unmatched pixels are filled.
enum class Fill {
  kConstant,  ///< the background depth next to them (EQUATIONS §5.4)
  kLinear,    ///< interpolated where the disparities on both sides nearly agree, else constant
  kMedian,    ///< constant, then the median of similar pixels nearby (filled_medians)
  kPlanes,  ///< the band that the other image never shows: planes (border_planes), then as kMedian
  kSurfaces,   ///< the same; before medians, hidden pixels: surfaces around (surface_fill)
  kCanonical,  ///< regions without texture: a membrane between their ends; others: as kMedian
  kThinPlate,  ///< the same with a thin plate
  kNone,       ///< unknown
};

/// A confidence_threshold below any confidence.
inline constexpr double kNoConfidenceThreshold = -std::numeric_limits<double>::infinity();

/// Refinement steps after the selection of winners (EQUATIONS §5), in processing order. Field =
/// std::optional: what a user sets; Field = std::type_identity_t: the values in force. Every field
/// must also be listed in visit_fields(); a missing one does not compile.
template <template <typename> class Field>
struct RefinementOptionsOf {
  /// Moves discontinuities to intensity edges at most this far away; 0: off; 0..16.
  Field<int> edge_snapping_px = by_default<Field>(0);
  Field<bool> cross_check = by_default<Field>(true);
  /// Left and right disparities agree if they differ by less than this, ≥ 1 (5.13).
  Field<double> cross_check_px = by_default<Field>(1.0);
  /// Pixels with at most this confidence are unmatched (5.14), in the unit of the method's
  /// confidence; −infinity: off.
  Field<double> confidence_threshold = by_default<Field>(kNoConfidenceThreshold);
  /// Matched regions of fewer pixels than this become unmatched; ≥ 0; 0 and 1: off.
  Field<int> speckle_size_px = by_default<Field>(0);
  /// Matched pixels get the values of planes fitted to matched pixels within this radius
  /// (surface_fit); 0: off; 0..16.
  Field<int> surface_fit_px = by_default<Field>(0);
  /// 1: a plane for each pixel; 2: for each block of 2×2 pixels, which is faster.
  Field<int> surface_fit_step_px = by_default<Field>(1);
  Field<Fill> fill = by_default<Field>(Fill::kConstant);
  /// Canonical and thin-plate fill: mean intensity difference of neighbouring columns, in grey
  /// levels, up to which a region has no texture; ≥ 0.
  Field<double> uniform_contrast = by_default<Field>(1.0);

  friend bool operator==(const RefinementOptionsOf&, const RefinementOptionsOf&) = default;
};

/// Empty fields take the preset's value, then the default.
using RefinementOverrides = RefinementOptionsOf<OptionalField>;
using RefinementOptions = RefinementOptionsOf<std::type_identity_t>;

/// Whether refinement reads the confidence of the maps.
inline bool uses_confidence(const RefinementOptions& refinement) {
  return refinement.confidence_threshold > kNoConfidenceThreshold;
}

/// Whether uniform regions are filled otherwise than other unmatched pixels.
inline bool fills_uniform_regions(Fill fill) {
  return fill == Fill::kCanonical || fill == Fill::kThinPlate;
}

/// Description of a field of RefinementOptions.
struct RefinementField {
  std::string_view option;  ///< name on the command line, in files and in messages
  Limits limits = {};
};

template <typename T>
concept AnyRefinementOptions = std::same_as<std::remove_const_t<T>, RefinementOverrides> ||
    std::same_as<std::remove_const_t<T>, RefinementOptions>;

/// Calls visit(RefinementField, options.field...) for every field, in the order of the options.
template <typename Visit, AnyRefinementOptions... Options>
constexpr void visit_fields(const Visit& visit, Options&... options) {
  using Field = RefinementField;
  constexpr Limits kRadius = {is_within<0, 16>, "a number of pixels from 0 to 16"};
  constexpr Limits kAgreement = {[](double v) { return v >= 1 && std::isfinite(v); },
                                 "a number of at least 1"};
  constexpr Limits kThreshold = {
      [](double v) { return v < std::numeric_limits<double>::infinity(); }, "a finite number"};
  constexpr Limits kContrast = {[](double v) { return v >= 0 && std::isfinite(v); },
                                "a number of grey levels, at least 0"};
  constexpr Limits kSize = {[](double v) { return v >= 0; }, "a number of pixels, at least 0"};

  visit(Field{"edge-snapping", kRadius}, options.edge_snapping_px...);
  // One option sets two fields, the number first: a number, or no check.
  visit(Field{"cross-check", kAgreement}, options.cross_check_px...);
  visit(Field{"cross-check"}, options.cross_check...);
  visit(Field{"confidence-threshold", kThreshold}, options.confidence_threshold...);
  visit(Field{"speckle-size", kSize}, options.speckle_size_px...);
  visit(Field{"surface-fit", kRadius}, options.surface_fit_px...);
  visit(Field{"surface-fit-step", {is_within<1, 2>, "1 or 2"}}, options.surface_fit_step_px...);
  visit(Field{"fill"}, options.fill...);
  visit(Field{"uniform-contrast", kContrast}, options.uniform_contrast...);
}

}  // namespace vantage
