#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace vantage {

/// The one way from JSON text to values. Brackets may be 64 deep: the library's functions call
/// themselves for each level, and no file of ours is a tenth as deep. Throws Error
/// "NAME:LINE:COLUMN: ..." for anything else than one JSON value.
nlohmann::ordered_json parse_json(std::string_view text, const std::string& name);

/// The same of a whole file. Throws Error when it cannot be read, too.
nlohmann::ordered_json read_json_file(const std::filesystem::path& file);

/// quotable() of a value: texts in '', all else as JSON.
std::string quoted_json(const nlohmann::ordered_json& value);

}  // namespace vantage
