#include "apps/toml_file.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <fstream>
#include <sstream>

#include "engine/error.h"

namespace vantage::apps {
namespace {

SettingValue from_toml(const toml::node& node, const std::string& path, std::string_view key) {
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
      list.push_back(from_toml(member, path, key));
    }
    return list;
  }
  throw UsageError(fmt::format(
      "{}:{}: '{}' is a table or a date, expected a number, a text, true, false or a list of these",
      path, node.source().begin.line, key));
}

}  // namespace

SettingValue read_toml(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  file.peek();  // a folder opens like a file and fails here
  if (!file.is_open() || file.bad()) {
    throw Error(fmt::format("{}: cannot be read, expected a TOML file with settings", path));
  }
  std::ostringstream content;
  content << file.rdbuf();
  try {
    const toml::table table = toml::parse(content.str(), path);
    SettingValue values = SettingValue::object();
    for (const auto& [key, node] : table) {
      values[std::string(key.str())] = from_toml(node, path, key.str());
    }
    return values;
  } catch (const toml::parse_error& error) {
    throw UsageError(
        fmt::format("{}:{}: not TOML: {}", path, error.source().begin.line, error.description()));
  }
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
