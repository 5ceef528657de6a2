#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "engine/error.h"
#include "engine/io/files/atomic_file.h"
#include "engine/io/files/checksum.h"
#include "engine/io/files/file_bytes.h"
#include "engine/io/files/json_text.h"
#include "engine/sequence/shots/shots.h"

namespace vantage {
namespace {

using Json = nlohmann::ordered_json;

Json json_of(const Shot& shot) {
  Json intensity = Json::array();
  for (const IntensityFit& fit : shot.intensity) {
    intensity.push_back({{"offset", fit.offset}, {"gain", fit.gain}});
  }
  // Floats as doubles, which are written without loss.
  Json json = {
      {"first_frame", shot.first_frame},
      {"end_frame", shot.end_frame},
      {"intensity", intensity},
      {"preview_range", {double{shot.preview_range.min_px}, double{shot.preview_range.max_px}}}};
  if (shot.search) {
    json["search"] = {shot.search->min, shot.search->max};
  }
  return json;
}

Shot shot_of_json(const Json& json) {
  Shot shot;
  shot.first_frame = int_of(json.at("first_frame"));
  shot.end_frame = int_of(json.at("end_frame"));
  for (std::size_t c = 0; c < shot.intensity.size(); ++c) {
    const Json& fit = json.at("intensity").at(c);
    shot.intensity[c] = {.offset = fit.at("offset").get<double>(),
                         .gain = fit.at("gain").get<double>()};
  }
  shot.preview_range = {json.at("preview_range").at(0).get<float>(),
                        json.at("preview_range").at(1).get<float>()};
  if (json.contains("search")) {
    shot.search = {int_of(json.at("search").at(0)), int_of(json.at("search").at(1))};
  }
  return shot;
}

void check(const ShotTable& table) {
  if (table.shots.empty()) {
    throw Error("shots: none, expected at least one");
  }
  for (std::size_t k = 0; k < table.shots.size(); ++k) {
    const Shot& shot = table.shots[k];
    if (shot.end_frame <= shot.first_frame) {
      throw Error(fmt::format("shots: shot {} has frames {} to {}, expected at least one", k,
                              shot.first_frame, shot.end_frame));
    }
    if (k > 0 && shot.first_frame != table.shots[k - 1].end_frame) {
      throw Error(
          fmt::format("shots: shot {} starts at frame {}, expected {}, where the previous one ends",
                      k, shot.first_frame, table.shots[k - 1].end_frame));
    }
    if (!(shot.preview_range.min_px < shot.preview_range.max_px)) {
      throw Error(
          fmt::format("shots: shot {} has a preview range of {} to {} px, expected the "
                      "smaller first",
                      k, shot.preview_range.min_px, shot.preview_range.max_px));
    }
    if (shot.search && shot.search->min > shot.search->max) {
      throw Error(
          fmt::format("shots: shot {} is searched from {} to {} px, expected the smaller first", k,
                      shot.search->min, shot.search->max));
    }
    for (const IntensityFit& fit : shot.intensity) {
      if (!(fit.gain > 0)) {
        throw Error(
            fmt::format("shots: shot {} has a gain of {}, expected more than 0", k, fit.gain));
      }
    }
  }
}

}  // namespace

std::string to_json(const ShotTable& table) {
  Json shots = Json::array();
  for (const Shot& shot : table.shots) {
    shots.push_back(json_of(shot));
  }
  return Json{{"shots", shots}}.dump(1) + "\n";
}

ShotTable shot_table_from_json(const std::string& text) {
  ShotTable table;
  try {
    const Json json = parse_json(text, "shots");
    for (const Json& shot : json.at("shots")) {
      table.shots.push_back(shot_of_json(shot));
    }
  } catch (const nlohmann::json::exception&) {
    throw Error(
        "shots: an entry is missing or has the wrong type, expected the entries that a run writes");
  }
  check(table);
  return table;
}

std::optional<ShotTable> read_shot_table(const std::filesystem::path& file) {
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) {
    return std::nullopt;
  }
  const std::vector<std::uint8_t> bytes = read_file_bytes(file);
  const std::string text(bytes.begin(), bytes.end());
  try {
    ShotTable table = shot_table_from_json(text);
    if (!has_valid_checksum(text)) {
      throw Error("wrong checksum");
    }
    return table;
  } catch (const Error& error) {
    throw Error(fmt::format(
        "{}: is damaged ({}), expected the shots of the run; remove the file to detect them again",
        file.string(), error.what()));
  }
}

ShotTable keep_shot_table(const std::filesystem::path& file, const ShotTable& table) {
  create_text_file(file, with_checksum(to_json(table)));
  const std::optional<ShotTable> kept = read_shot_table(file);
  if (!kept) {
    throw Error(fmt::format("{}: was removed while the run started", file.string()));
  }
  return *kept;
}

}  // namespace vantage
