#include "apps/tell.h"

#include <cstdio>

namespace vantage::apps {

void tell_text(std::string_view text) noexcept {
  (void)std::fwrite(text.data(), 1, text.size(), stderr);
  (void)std::fflush(stderr);
}

}  // namespace vantage::apps
