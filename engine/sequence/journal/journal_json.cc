#include "engine/sequence/journal/journal_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <string_view>
#include <vector>

#include "engine/build_info.h"
#include "engine/error.h"
#include "engine/io/files/checksum.h"
#include "engine/io/files/encoded_text.h"
#include "engine/io/files/json_text.h"

namespace vantage {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kJournalFormat = 3;

/// Throws nlohmann's exceptions unless it is an integer ≥ 0.
int count_of(const Json& json) {
  constexpr Json::number_unsigned_t kMax = std::numeric_limits<int>::max() - 1;
  return static_cast<int>(std::min(json.get_ref<const Json::number_unsigned_t&>(), kMax));
}

Json range_json(FrameRange frames) { return Json::array({frames.first, frames.end}); }
FrameRange range_of(const Json& json) { return {int_of(json.at(0)), int_of(json.at(1))}; }

Json comfort_json(const FrameComfort& comfort) {
  Json json = {{"size", {comfort.width_px, comfort.height_px}},
               {"matched", comfort.matched},
               {"disparity", comfort.disparity},
               {"borders", Json::array()},
               {"order", {comfort.order_right, comfort.order_wrong}},
               {"colour", comfort.colour}};
  for (const FrameComfort::Border& border : comfort.borders) {
    json["borders"].push_back({border.rows, border.disparity});
  }
  if (comfort.vertical) {
    json["vertical"] = {comfort.vertical->mean, comfort.vertical->systematic};
  }
  return json;
}

FrameComfort comfort_of(const Json& json) {
  FrameComfort comfort;
  const auto number = [](const Json& list, std::size_t i) { return int_of(list.at(i)); };
  comfort.width_px = number(json.at("size"), 0);
  comfort.height_px = number(json.at("size"), 1);
  comfort.matched = int_of(json.at("matched"));
  json.at("disparity").get_to(comfort.disparity);
  for (std::size_t i = 0; i < comfort.borders.size(); ++i) {
    const Json& border = json.at("borders").at(i);
    comfort.borders[i] = {number(border, 0), number(border, 1)};
  }
  comfort.order_right = number(json.at("order"), 0);
  comfort.order_wrong = number(json.at("order"), 1);
  json.at("colour").get_to(comfort.colour);
  if (json.contains("vertical")) {
    comfort.vertical = {number(json.at("vertical"), 0), number(json.at("vertical"), 1)};
  }
  return comfort;
}

/// {"disparity/000000.pfm": [12345, "00112233"], …}
Json files_json(const std::vector<FileRecord>& files) {
  Json json = Json::object();
  for (const FileRecord& file : files) {
    json[file.name] = {file.content.bytes, fmt::format("{:08x}", file.content.crc32)};
  }
  return json;
}

std::vector<FileRecord> files_in(const Json& json) {
  std::vector<FileRecord> files;
  if (!json.contains("files")) {
    return files;
  }
  for (const auto& [name, content] : json.at("files").get_ref<const Json::object_t&>()) {
    const auto& digits = content.at(1).get_ref<const std::string&>();
    FileRecord file{name, {content.at(0).get_ref<const Json::number_unsigned_t&>(), 0}};
    std::from_chars(digits.data(), digits.data() + digits.size(), file.content.crc32, 16);
    files.push_back(std::move(file));
  }
  return files;
}

struct ToJson {
  Json operator()(const FrameRecord& record) const {
    Json json = {{"frame", record.frame}};
    if (!record.name.empty()) {
      json["name"] = record.name;
    }
    if (record.skipped) {
      json["skipped"] = record.problem;
    }
    if (record.absent) {
      json["absent"] = true;
    }
    const auto add_list = [&](const char* key, const auto& list) {
      if (!list.empty()) {
        json[key] = list;
      }
    };
    if (!record.files.empty()) {
      json["files"] = files_json(record.files);
    }
    add_list("remarks", record.remarks);
    if (record.comfort) {
      json["comfort"] = comfort_json(*record.comfort);
    }
    if (record.disparities) {
      const auto& [px, scale] = *record.disparities;
      json["disparities"] = {px.nearest_px, px.median_px, px.farthest_px};
      json["scale"] = {scale.focal_length_px, scale.baseline, scale.doffs_px};
    }
    return json;
  }
  Json operator()(const SegmentRecord& record) const {
    return {{"segment", range_json(record.frames)}, {"files", files_json(record.files)}};
  }
  Json operator()(const JoinRecord& record) const {
    Json json = {{"joined", range_json(record.frames)}};
    if (!record.skipped.empty()) {
      json["skipped"] = record.skipped;
    }
    json["files"] = files_json(record.files);
    return json;
  }
  Json operator()(const ReportRecord& record) const {
    return {{"reported", range_json(record.frames)}, {"files", files_json(record.files)}};
  }
};

/// Throws nlohmann's exceptions for other JSON.
JournalRecord record_in(const Json& json) {
  if (json.contains("segment")) {
    return SegmentRecord{range_of(json.at("segment")), files_in(json)};
  }
  if (json.contains("joined")) {
    JoinRecord record{range_of(json.at("joined")), {}, files_in(json)};
    for (const Json& frame : json.value("skipped", Json::array())) {
      record.skipped.push_back(int_of(frame));
    }
    return record;
  }
  if (json.contains("reported")) {
    return ReportRecord{range_of(json.at("reported")), files_in(json)};
  }
  FrameRecord record;
  record.frame = count_of(json.at("frame"));
  record.name = json.value("name", "");
  record.skipped = json.contains("skipped");
  record.problem = json.value("skipped", "");
  record.absent = json.value("absent", false);
  record.files = files_in(json);
  record.remarks = json.value("remarks", record.remarks);
  if (json.contains("comfort")) {
    record.comfort = comfort_of(json.at("comfort"));
  }
  if (json.contains("disparities")) {
    const Json& px = json.at("disparities");
    const Json& scale = json.at("scale");
    record.disparities = {
        {px.at(0).get<float>(), px.at(1).get<float>(), px.at(2).get<float>()},
        {scale.at(0).get<double>(), scale.at(1).get<double>(), scale.at(2).get<double>()}};
  }
  return record;
}

/// The part of an input's line that identifies its content: machines may see the files at different
/// paths.
std::string_view content_of(std::string_view input) {
  const std::size_t name_end = input.rfind(": ");
  return name_end == std::string_view::npos ? input : input.substr(name_end);
}

/// Lists of poses would fill pages.
std::string change_of(const std::string& key, const std::string& before, const std::string& now) {
  constexpr std::size_t kMaxShown = 100;
  return before.size() > kMaxShown || now.size() > kMaxShown
             ? fmt::format("{} was another one", key)
             : fmt::format("{} was {}, now {}", key, before, now);
}

/// Whether a run may continue with this setting: sound that causes trouble may be left out of
/// videos that are not joined yet.
bool may_become(const std::string& key, const Json& now) {
  return key == "no-sound" && now == true;
}

Json json_of(const FrameTimes& frames) {
  return {{"times", frames.times},
          {"unit_seconds", {frames.unit_numerator, frames.unit_denominator}},
          {"rate", to_string(frames.rate)}};
}

FrameTimes frame_times_in(const Json& json) {
  const Json& unit = json.at("unit_seconds");
  return {json.at("times").get<std::vector<std::int64_t>>(), unit.at(0).get<std::int64_t>(),
          unit.at(1).get<std::int64_t>(),
          parse_frame_rate(json.at("rate").get<std::string>()).value_or(FrameRate())};
}

}  // namespace

std::string line_of(const JournalRecord& record) {
  return with_checksum(
             std::visit(ToJson(), record).dump(-1, ' ', false, Json::error_handler_t::replace)) +
         "\n";
}

std::optional<JournalRecord> record_of(const std::string& line) {
  if (!has_valid_checksum(line)) {
    return std::nullopt;
  }
  try {
    return record_in(parse_json(line, "journal"));
  } catch (const Error&) {
    return std::nullopt;
  } catch (const nlohmann::json::exception&) {
    return std::nullopt;
  }
}

std::string text_of(const RunIdentity& identity) {
  Json json = {{"format", kJournalFormat},
               {"version", build_info().version},
               {"frame_count", identity.is_stream() ? Json() : Json(identity.frame_count)},
               {"inputs", identity.inputs},
               {"sound",
                {{"file", stored_name(identity.sound_file.string())},
                 {"first_frame", identity.sound_first_frame},
                 {"rate", to_string(identity.sound_rate)}}},
               {"sources", parse_json(identity.sources, "sources")},
               {"settings", parse_json(identity.settings, "settings")}};
  if (identity.frame_times) {
    json["frame_times"] = json_of(*identity.frame_times);
  }
  if (identity.replaces_records) {
    json["replaces_records"] = true;
  }
  return with_checksum(json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

RunIdentity identity_of(const std::string& text, const std::filesystem::path& file) {
  try {
    const Json json = parse_json(text, file.string());
    if (int_of(json.at("format")) != kJournalFormat) {
      throw Error(
          fmt::format("{}: has format {} (written by Vantage {}), expected {}; finish the run with "
                      "that version, or start again with `overwrite`",
                      file.string(), quoted_json(json.at("format")), json.value("version", "?"),
                      kJournalFormat));
    }
    if (!has_valid_checksum(text)) {
      throw Error(fmt::format("{}: is damaged, wrong checksum", file.string()));
    }
    RunIdentity identity;
    // Throws unless it is an object.
    identity.settings = Json(json.at("settings").get_ref<const Json::object_t&>()).dump();
    identity.sources = Json(json.at("sources").get_ref<const Json::object_t&>()).dump();
    identity.inputs = json.at("inputs").get<std::vector<std::string>>();
    const Json& frames = json.at("frame_count");
    identity.frame_count = frames.is_null() ? kUnknownFrames : count_of(frames);
    identity.sound_file = name_of_stored(json.at("sound").at("file").get<std::string>());
    identity.sound_first_frame = json.at("sound").at("first_frame").get<double>();
    identity.sound_rate =
        parse_frame_rate(json.at("sound").at("rate").get<std::string>()).value_or(FrameRate());
    if (const auto times = json.find("frame_times"); times != json.end()) {
      identity.frame_times = frame_times_in(*times);
    }
    identity.replaces_records = json.value("replaces_records", false);
    return identity;
  } catch (const nlohmann::json::exception&) {
    throw Error(fmt::format("{}: is damaged, expected the description of a run", file.string()));
  }
}

std::string difference(const RunIdentity& then, const RunIdentity& now) {
  const Json old_settings = parse_json(then.settings, "settings");
  // Round trip through text, so that numbers compare as stored.
  const Json new_settings = parse_json(now.settings, "settings");
  std::vector<std::string> found;
  for (const auto& [key, value] : new_settings.items()) {
    const Json before = old_settings.value(key, Json());
    if (before != value && !may_become(key, value)) {
      found.push_back(change_of(key, before.dump(), value.dump()));
    }
  }
  for (const auto& [key, value] : old_settings.items()) {
    if (!new_settings.contains(key)) {
      found.push_back(change_of(key, value.dump(), "not set"));
    }
  }
  for (std::size_t i = 0; i < std::max(then.inputs.size(), now.inputs.size()); ++i) {
    const std::string before = i < then.inputs.size() ? then.inputs[i] : "none";
    const std::string after = i < now.inputs.size() ? now.inputs[i] : "none";
    if (content_of(before) != content_of(after)) {
      found.push_back(fmt::format("the input was '{}', now '{}'", before, after));
    }
  }
  if (found.empty() && then.frame_count != now.frame_count) {
    found.push_back(
        fmt::format("the input had {} frames, now {}", then.frame_count, now.frame_count));
  }
  if (found.empty()) {
    return "";
  }
  return found.front() +
         (found.size() > 1 ? fmt::format(" (and {} more)", found.size() - 1) : std::string());
}

}  // namespace vantage
