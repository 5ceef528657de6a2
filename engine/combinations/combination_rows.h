#pragma once

#include <initializer_list>
#include <string_view>
#include <vector>

#include "engine/combinations/combinations.h"

namespace vantage {

// The rows of combinations(), by who refuses them.
std::vector<Combination> method_combinations();
std::vector<Combination> match_combinations();
std::vector<Combination> sequence_combinations();
std::vector<Combination> job_combinations();
std::vector<Combination> match_job_combinations();

// Their parts.
using OptionNames = std::initializer_list<std::string_view>;

/// Options that are idle unless one of `only_with` holds; `why`: "without --video".
void add_idle(std::vector<Combination>& rows, CombinationScope scope, OptionNames options,
              const std::vector<Condition>& only_with, std::string_view why);
/// Options that are idle with `with`.
void add_idle_with(std::vector<Combination>& rows, CombinationScope scope, OptionNames options,
                   const Condition& with, std::string_view why);
void add_refused(std::vector<Combination>& rows, CombinationScope scope, const Condition& option,
                 const std::vector<Condition>& with, std::string_view reason,
                 std::string_view message);
/// Several images of cameras on one line; photographs that are not rectified.
void add_several(std::vector<Combination>& rows, CombinationScope scope);
void add_idle_unrectified(std::vector<Combination>& rows, CombinationScope scope);

}  // namespace vantage
