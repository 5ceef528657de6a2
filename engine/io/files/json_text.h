#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace vantage {

/// The only JSON parser of the engine. Brackets may be nested 64 deep: the library recurses for
/// each level, and our files need less than a tenth of that. Throws Error "NAME:LINE:COLUMN: ..."
/// for anything other than one JSON value.
nlohmann::ordered_json parse_json(std::string_view text, const std::string& name);

/// parse_json() of a whole file. Throws Error also when it cannot be read.
nlohmann::ordered_json read_json_file(const std::filesystem::path& file);

/// Throws nlohmann's exceptions unless it is an integer; one that is no int becomes the nearest.
int int_of(const nlohmann::ordered_json& json);

/// quotable() of a value: strings in '', everything else as JSON.
std::string quoted_json(const nlohmann::ordered_json& value);

}  // namespace vantage
