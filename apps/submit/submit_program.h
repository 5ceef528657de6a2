#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace vantage::apps {

/// Throws Error where the program that submits is not in the PATH.
void require_submitting_program(std::string_view program);

/// What the command, which hands a job over, prints. Throws Error with its message where it fails.
std::string output_of_submission(const std::vector<std::string>& command);

}  // namespace vantage::apps
