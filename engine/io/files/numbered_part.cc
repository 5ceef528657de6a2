#include "engine/io/files/numbered_part.h"

#include <charconv>
#include <string>
#include <system_error>

#include "engine/io/files/remote_files.h"

namespace vantage {

NumberedPart numbered_part(const std::filesystem::path& spec) {
  const std::string text = spec.string();
  const std::size_t hash = text.rfind('#');
  if (hash == std::string::npos || hash == 0 || is_there(spec)) {
    return {spec};
  }
  int number = -1;
  const char* const end = text.data() + text.size();
  const auto [rest, problem] = std::from_chars(text.data() + hash + 1, end, number);
  const bool is_number = problem == std::errc() && rest == end && number >= 0;
  return is_number ? NumberedPart{text.substr(0, hash), number} : NumberedPart{spec};
}

}  // namespace vantage
