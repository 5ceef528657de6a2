#include "apps/process/tell.h"

#include <unistd.h>

#include <regex>

#include "engine/io/files/file_descriptor.h"

namespace vantage::apps {

void tell_text(std::string_view text) noexcept {
  (void)write_all(STDERR_FILENO, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

std::string with_dashes(std::string_view message) {
  static const std::regex name("`([a-z]+(-[a-z]+)*)`");
  return std::regex_replace(std::string(message), name, "--$1");
}

}  // namespace vantage::apps
