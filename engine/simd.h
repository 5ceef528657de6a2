#pragma once

#include <string>
#include <vector>

namespace vantage {

/// Names of the instruction sets that this build has kernels for, best first.
std::vector<std::string> built_instruction_sets();

/// Names of the instruction sets that kernels can run on here, best first.
std::vector<std::string> available_instruction_sets();

/// Makes all kernels use `name` from now on, "best" for the default. Call it before any work
/// starts. Throws UsageError that lists the known names. Affects the whole process.
void force_instruction_set(const std::string& name);

std::string instruction_set_in_use();

}  // namespace vantage
