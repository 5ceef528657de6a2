#pragma once

#include <string>
#include <vector>

namespace vantage {

/// Instruction sets that this build has kernels for, best first.
std::vector<std::string> built_instruction_sets();

/// Instruction sets that kernels can use on this processor, best first.
std::vector<std::string> available_instruction_sets();

/// Makes all kernels use `name`; "best" selects the default. Call it before any work starts.
/// Affects the whole process. Throws UsageError that lists the known names.
void force_instruction_set(const std::string& name);

std::string instruction_set_in_use();

}  // namespace vantage
