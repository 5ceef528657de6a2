#pragma once

#include <fmt/format.h>

#include <string_view>
#include <utility>

namespace vantage::apps {

/// Writes `text` to stderr as it is. Whether anybody can read it (a full disk, a closed descriptor,
/// a pipe without a reader) never decides how a command ends.
void tell_text(std::string_view text) noexcept;

/// The same of a format and what goes into it: remarks, warnings, summaries.
template <typename... Args>
void tell(fmt::format_string<Args...> format, Args&&... args) {
  tell_text(fmt::format(format, std::forward<Args>(args)...));
}

}  // namespace vantage::apps
