#include "engine/io/files/numbered_part.h"

#include <charconv>
#include <string>
#include <system_error>

namespace vantage {

NumberedPart numbered_part(const std::filesystem::path& spec) {
  const std::string text = spec.string();
  const std::size_t hash = text.rfind('#');
  std::error_code ignored;
  if (hash == std::string::npos || hash == 0 || std::filesystem::exists(spec, ignored)) {
    return {spec};
  }
  int number = -1;
  const char* const end = text.data() + text.size();
  const auto [rest, problem] = std::from_chars(text.data() + hash + 1, end, number);
  const bool is_number = problem == std::errc() && rest == end && number >= 0;
  return is_number ? NumberedPart{text.substr(0, hash), number} : NumberedPart{spec};
}

}  // namespace vantage
