#include "engine/io/files/json_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "engine/error.h"
#include "engine/io/files/file_bytes.h"
#include "engine/quoted_text.h"

namespace vantage {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kMaxLevels = 64;

[[noreturn]] void fail_at(std::size_t byte, std::string_view text, const std::string& name,
                          const std::string& problem) {
  const std::string_view before = text.substr(0, std::min(byte, text.size()));
  const auto line = 1 + std::count(before.begin(), before.end(), '\n');
  const std::size_t line_begin = before.rfind('\n') + 1;  // npos + 1 is 0
  throw Error(fmt::format("{}:{}:{}: {}", name, line, before.size() - line_begin + 1, problem));
}

/// Position of the first bracket nested deeper than allowed.
std::optional<std::size_t> find_too_deep(std::string_view text) {
  int level = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (in_string) {
      i += c == '\\' ? 1 : 0;
      in_string = c != '"';
    } else if (c == '"') {
      in_string = true;
    } else if (c == '[' || c == '{') {
      if (++level > kMaxLevels) {
        return i;
      }
    } else if (c == ']' || c == '}') {
      --level;
    }
  }
  return std::nullopt;
}

/// The library's message without its error numbers and positions.
std::string reason_of(std::string_view message) {
  for (const std::string_view mark : {" - ", "] "}) {
    if (const std::size_t at = message.find(mark); at != std::string_view::npos) {
      return quotable(message.substr(at + mark.size()));
    }
  }
  return quotable(message);
}

}  // namespace

Json parse_json(std::string_view text, const std::string& name) {
  if (const auto place = find_too_deep(text)) {
    fail_at(*place, text, name,
            fmt::format("brackets are nested too deep, expected at most {} levels", kMaxLevels));
  }
  try {
    return Json::parse(text);
  } catch (const nlohmann::json::parse_error& error) {
    const std::size_t byte = error.byte > 0 ? error.byte - 1 : 0;
    fail_at(byte, text, name, "is not JSON: " + reason_of(error.what()));
  } catch (const nlohmann::json::exception& error) {
    throw Error(fmt::format("{}: is not JSON: {}", name, reason_of(error.what())));
  }
}

Json read_json_file(const std::filesystem::path& file) {
  return parse_json(read_file_text(file), file.string());
}

int int_of(const Json& json) {
  using Limits = std::numeric_limits<int>;
  const auto value = json.get_ref<const Json::number_integer_t&>();
  return static_cast<int>(std::clamp<Json::number_integer_t>(value, Limits::min(), Limits::max()));
}

std::string quoted_json(const Json& value) {
  if (value.is_string()) {
    return fmt::format("'{}'", quotable(value.get_ref<const std::string&>()));
  }
  if (value.is_number_float() && !std::isfinite(value.get<double>())) {
    return fmt::format("{}", value.get<double>());  // JSON has none and writes null
  }
  return quotable(value.dump(-1, ' ', false, Json::error_handler_t::replace));
}

}  // namespace vantage
