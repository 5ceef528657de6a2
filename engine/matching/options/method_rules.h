#pragma once

#include "engine/matching/parameters/method_parameters.h"

namespace vantage {

/// `overrides`, and where they are empty `defaults`.
MethodOverrides merge(const MethodOverrides& defaults, const MethodOverrides& overrides);

/// Overrides that leave nothing to preset or method.
MethodOverrides as_overrides(const MethodParameters& parameters);

/// The book's parameters of a method.
MethodParameters book_parameters(MatchMethod method);

/// `overrides`, then the book's parameters of `method`, whose cost is adapted to the aggregation
/// where only the aggregation was overridden.
MethodParameters resolve(MatchMethod method, const MethodOverrides& overrides);

/// Throws UsageError naming field, value and limit, or why a combination makes no sense.
void validate(const MethodParameters& parameters);

/// Whether candidates of fine levels can be left out (candidate_blocks): Bayes with several levels,
/// the prior's maximum and any cost but evidence.
bool can_prune(const MethodParameters& parameters);

/// Whether σM takes part.
bool uses_sigma_measurement(const MethodParameters& parameters);

/// Whether something is to be estimated from each pair's grey levels.
bool uses_pair_exposure(const MethodParameters& parameters);

}  // namespace vantage
