#pragma once

#include <string_view>

namespace vantage::kernels {

/// Instruction sets this build has kernels for, independent of the processor, as a bit mask of
/// Highway targets.
long long built_targets();

/// Instruction sets this build has kernels for and this processor can run, best first, as a bit
/// mask of Highway targets; see target_name(). Thread rule: all functions here are called from one
/// thread while no kernel runs.
long long available_targets();

/// The target that kernels run on.
long long target_in_use();

/// Makes kernels run on `target`, one bit of available_targets(). 0 restores the best one.
void force_target(long long target);

/// Highway's name of one target: "AVX3_DL", "AVX3", "AVX2", "SSE4"
std::string_view target_name(long long target);

}  // namespace vantage::kernels
