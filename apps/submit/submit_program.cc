#include "apps/submit/submit_program.h"

#include <fmt/format.h>

#include <algorithm>

#include "apps/process/child_process.h"
#include "engine/error.h"

namespace vantage::apps {

void require_submitting_program(std::string_view program) {
  if (!program_exists(std::string(program))) {
    throw Error(fmt::format(
        "{} is not in the PATH, expected the program that submits; without --go files are only "
        "written",
        program));
  }
}

std::string output_of_submission(const std::vector<std::string>& command) {
  const ProgramResult result = run_program(command);
  if (result.exit_code != 0) {
    std::string message = result.err.empty() ? result.out : result.err;
    std::ranges::replace(message, '\n', ' ');
    message.erase(message.find_last_not_of(' ') + 1);
    throw Error(
        fmt::format("{}: refused by {}: {}", command.back(), command.front(),
                    message.empty() ? fmt::format("exit code {}", result.exit_code) : message));
  }
  return result.out;
}

}  // namespace vantage::apps
