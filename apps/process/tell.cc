#include "apps/process/tell.h"

#include <cstdio>
#include <regex>

namespace vantage::apps {

void tell_text(std::string_view text) noexcept {
  (void)std::fwrite(text.data(), 1, text.size(), stderr);
  (void)std::fflush(stderr);
}

std::string with_dashes(std::string_view message) {
  static const std::regex name("`([a-z]+(-[a-z]+)*)`");
  return std::regex_replace(std::string(message), name, "--$1");
}

}  // namespace vantage::apps
