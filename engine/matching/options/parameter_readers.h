#pragma once

#include <span>
#include <string_view>

#include "engine/matching/options/method_parameters.h"

namespace vantage {

/// A parameter of MethodParameters, and what reads it.
struct ParameterReaders {
  std::string_view name;     ///< that of the option and of messages
  std::string_view readers;  ///< what reads it, in words, for messages: "the aggregation box"
  bool (*is_set)(const MethodOverrides& overrides);
  /// Whether results of these parameters can depend on it. That it is 0 where it can only be 0
  /// (candidate_blocks) counts as read.
  bool (*is_read)(const MethodParameters& in_force);
};

/// Every parameter once, in the order of the options. What costs, aggregations and levels read is
/// said nowhere else.
std::span<const ParameterReaders> parameter_readers();

/// Throws UsageError for the first parameter that `overrides` sets and nothing reads where
/// `in_force` is. `chosen`: what is in force, in words.
void require_read(const MethodOverrides& overrides, const MethodParameters& in_force,
                  std::string_view chosen);

}  // namespace vantage
