#pragma once

#include "engine/matching/parameters/method_parameters.h"

namespace vantage {

/// `overrides`; empty fields are taken from `defaults`.
MethodOverrides merge(const MethodOverrides& defaults, const MethodOverrides& overrides);

/// Overrides with every field set.
MethodOverrides as_overrides(const MethodParameters& parameters);

/// The book's parameters of a method.
MethodParameters book_parameters(MatchMethod method);

/// `overrides`; empty fields are taken from the book's parameters of `method`. If only the
/// aggregation is overridden, the cost is adapted to it.
MethodParameters resolve(MatchMethod method, const MethodOverrides& overrides);

/// Throws UsageError naming field, value and limit, or why a combination is invalid.
void validate(const MethodParameters& parameters);

/// Whether candidates of fine levels can be pruned (candidate_blocks): Bayes with several levels,
/// the largest term of a prior other than the quadratic one, and any cost but evidence.
bool can_prune(const MethodParameters& parameters);

/// Whether fine levels can search windows of candidates (window_levels): Bayes with several levels,
/// the largest term of a prior other than the quadratic one, and ray census codes of luma.
bool can_search_windows(const MethodParameters& parameters);

/// Whether candidates can be searched in reduced images (search_size): as can_search_windows(),
/// with one threshold.
bool can_reduce_search(const MethodParameters& parameters);

/// Whether σM is used.
bool uses_sigma_measurement(const MethodParameters& parameters);

}  // namespace vantage
