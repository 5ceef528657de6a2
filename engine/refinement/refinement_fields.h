#pragma once

#include <cmath>
#include <concepts>
#include <string_view>
#include <type_traits>

#include "engine/option_field.h"
#include "engine/refinement/refinement_options.h"

namespace vantage {

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
  visit(Field{"cross-check-level", {is_within<0, 9>, "a level from 0 to 9"}},
        options.cross_check_level...);
  visit(Field{"confidence-threshold", kThreshold}, options.confidence_threshold...);
  visit(Field{"speckle-size", kSize}, options.speckle_size_px...);
  visit(Field{"surface-fit", kRadius}, options.surface_fit_px...);
  visit(Field{"surface-fit-step", {is_within<1, 2>, "1 or 2"}}, options.surface_fit_step_px...);
  visit(Field{"fill"}, options.fill...);
  visit(Field{"uniform-contrast", kContrast}, options.uniform_contrast...);
}

}  // namespace vantage
