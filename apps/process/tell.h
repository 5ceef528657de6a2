#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>
#include <utility>

namespace vantage::apps {

/// Writes `text` to stderr unchanged. Failures (full disk, closed descriptor, pipe without reader)
/// are ignored: they never change how a command ends.
void tell_text(std::string_view text) noexcept;

/// Formats a message (note, warning, summary) and writes it to stderr.
template <typename... Args>
void tell(fmt::format_string<Args...> format, Args&&... args) {
  tell_text(fmt::format(format, std::forward<Args>(args)...));
}

/// A message of the engine, which names options as `name` because not all its users have a command
/// line, with --name instead.
std::string with_dashes(std::string_view message);

}  // namespace vantage::apps
