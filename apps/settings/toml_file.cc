#include "apps/settings/toml_file.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <fstream>
#include <sstream>
#include <vector>

#include "engine/error.h"
#include "engine/io/files/file_bytes.h"
#include "engine/io/files/remote_files.h"
#include "engine/quoted_text.h"

namespace vantage::apps {
namespace {

/// Whether values may be tables, down to any depth.
enum class Tables { kRefused, kAccepted };

SettingValue from_toml(const toml::node& node, const std::string& path, std::string_view key,
                       Tables tables) {
  if (const auto* truth = node.as_boolean()) {
    return truth->get();
  }
  if (const auto* integer = node.as_integer()) {
    return integer->get();
  }
  if (const auto* number = node.as_floating_point()) {
    return number->get();
  }
  if (const auto* text = node.as_string()) {
    return text->get();
  }
  if (const auto* array = node.as_array()) {
    SettingValue list = SettingValue::array();
    for (const toml::node& member : *array) {
      list.push_back(from_toml(member, path, key, tables));
    }
    return list;
  }
  if (const auto* table = node.as_table(); table != nullptr && tables == Tables::kAccepted) {
    SettingValue object = SettingValue::object();
    for (const auto& [name, member] : *table) {
      object[std::string(name.str())] = from_toml(member, path, name.str(), tables);
    }
    return object;
  }
  throw UsageError(fmt::format(
      "{}:{}: '{}' is a table or a date, expected a number, a text, true, false or a list of these",
      path, node.source().begin.line, quotable(key)));
}

/// Whether a key has more parts than tables may be deep: the library goes down one table after the
/// other, without a limit. Texts and comments do not count.
bool has_too_deep_key(std::string_view text) {
  constexpr int kMaxLevels = 64;
  int dots = 0;
  char quote = 0;
  bool in_comment = false;
  for (std::size_t i = 0; i < text.size() && dots < kMaxLevels; ++i) {
    const char c = text[i];
    if (in_comment || quote != 0) {
      i += quote == '"' && c == '\\' ? 1 : 0;
      quote = c == quote ? 0 : quote;
      in_comment = in_comment && c != '\n';
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == '#') {
      in_comment = true;
    } else if (c == '.') {
      ++dots;
    } else if (std::string_view("=,[{\n").find(c) != std::string_view::npos) {
      dots = 0;
    }
  }
  return dots == kMaxLevels;
}

SettingValue read_file(const std::string& path, std::string_view expected, Tables tables) {
  std::ifstream file(path, std::ios::binary);
  std::string content = is_address(path) ? read_file_text(path, true) : "";
  for (std::vector<char> block(std::size_t{1} << 16); file;) {
    file.read(block.data(), static_cast<std::streamsize>(block.size()));
    content.append(block.data(), static_cast<std::size_t>(file.gcount()));
  }
  if (!is_address(path) && (!file.is_open() || file.bad())) {  // a folder opens like a file
    throw Error(fmt::format("{}: cannot be read, expected {}", path, expected));
  }
  if (has_too_deep_key(content)) {
    throw UsageError(fmt::format("{}: a key has more than 64 parts, expected {}", path, expected));
  }
  try {
    const toml::table table = toml::parse(content, path);
    SettingValue values = SettingValue::object();
    for (const auto& [key, node] : table) {
      values[std::string(key.str())] = from_toml(node, path, key.str(), tables);
    }
    return values;
  } catch (const toml::parse_error& error) {
    throw UsageError(fmt::format("{}:{}: not TOML: {}", path, error.source().begin.line,
                                 quotable(error.description())));
  }
}

}  // namespace

SettingValue read_toml(const std::string& path) {
  return read_file(path, "a TOML file with settings", Tables::kRefused);
}

SettingValue read_toml_document(const std::string& path) {
  return read_file(path, "a TOML file", Tables::kAccepted);
}

std::string to_toml(const SettingValue& value) {
  if (value.is_array()) {
    std::string list = "[";
    for (const SettingValue& member : value) {
      list += (list.size() > 1 ? ", " : "") + to_toml(member);
    }
    return list + "]";
  }
  if (value.is_string()) {
    std::ostringstream text;
    text << toml::value<std::string>(value.get<std::string>());
    return text.str();
  }
  return value.dump();  // JSON's numbers and truth values are TOML's
}

}  // namespace vantage::apps
