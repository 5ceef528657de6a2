#include "engine/tuning/tuning_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <nlohmann/json.hpp>
#include <system_error>
#include <utility>

#include "engine/error.h"
#include "engine/io/files/atomic_file.h"
#include "engine/io/files/file_bytes.h"
#include "engine/io/files/file_descriptor.h"
#include "engine/io/files/json_text.h"
#include "engine/quoted_text.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kKind = "vantage tuning";
constexpr int kTuningFormat = 1;
// Larger files are not tuning files.
constexpr std::uintmax_t kMaxBytes = std::uintmax_t{16} << 20;

Json json_of(const TunedPlan& plan) {
  Json settings = Json::object();
  for (const TuningCoordinate& coordinate : kTuningCoordinates) {
    if (const std::optional<int>& value = plan.settings.*coordinate.field) {
      settings[std::string(coordinate.name)] = *value;
    }
  }
  return {{"settings", settings},
          {"frame_seconds", plan.frame_seconds},
          {"default_frame_seconds", plan.default_frame_seconds},
          {"ratio_to_default", plan.ratio_to_default},
          {"measurements", plan.measurements},
          {"measured_rows", plan.measured_rows},
          {"date", plan.date}};
}

Json json_of(const TuningEntry& entry) {
  Json json = {{"machine", entry.key.machine},
               {"threads", entry.key.threads},
               {"method", entry.key.method},
               {"size", entry.key.size},
               {"version", entry.key.version}};
  if (entry.match) {
    json["match"] = json_of(*entry.match);
  }
  if (entry.run) {
    json["run"] = json_of(*entry.run);
  }
  return json;
}

std::string text_of(const std::vector<TuningEntry>& entries) {
  Json list = Json::array();
  for (const TuningEntry& entry : entries) {
    list.push_back(json_of(entry));
  }
  const Json document = {{"kind", kKind}, {"format", kTuningFormat}, {"entries", list}};
  return document.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

/// An integer of `field`; no fraction, boolean or string.
int whole_number(const Json& json, const std::string& field) {
  if (!json.is_number_integer() || json.get<double>() < 0 || json.get<double>() > 1e9) {
    throw UsageError(fmt::format("{} is {}, expected a whole number", field, quoted_json(json)));
  }
  return json.get<int>();
}

double number(const Json& json, const std::string& field, double min) {
  const double value = json.is_number() ? json.get<double>() : std::nan("");
  if (!(std::isfinite(value) && value >= min)) {
    throw UsageError(
        fmt::format("{} is {}, expected a number of at least {}", field, quoted_json(json), min));
  }
  return value;
}

/// Throws nlohmann's exceptions, or UsageError.
TunedPlan plan_of(const Json& json) {
  TunedPlan plan;
  for (const auto& [name, value] : json.at("settings").items()) {
    const auto coordinate = std::ranges::find(kTuningCoordinates, name, &TuningCoordinate::name);
    if (coordinate == kTuningCoordinates.end()) {
      throw UsageError(fmt::format("'{}' is not a setting", quotable(name)));
    }
    plan.settings.*coordinate->field = whole_number(value, name);
  }
  plan.settings.validate();
  plan.frame_seconds = number(json.at("frame_seconds"), "frame_seconds", 0);
  plan.default_frame_seconds = number(json.at("default_frame_seconds"), "default_frame_seconds", 0);
  plan.ratio_to_default = number(json.at("ratio_to_default"), "ratio_to_default", 0);
  plan.measurements = whole_number(json.at("measurements"), "measurements");
  plan.measured_rows = whole_number(json.at("measured_rows"), "measured_rows");
  plan.date = json.at("date").get<std::string>();
  return plan;
}

TuningEntry entry_of(const Json& json) {
  TuningEntry entry;
  entry.key = {.machine = json.at("machine").get<std::string>(),
               .threads = json.at("threads").get<std::string>(),
               .method = json.at("method").get<std::string>(),
               .size = json.at("size").get<std::string>(),
               .version = json.at("version").get<std::string>()};
  if (json.contains("match")) {
    entry.match = plan_of(json.at("match"));
  }
  if (json.contains("run")) {
    entry.run = plan_of(json.at("run"));
  }
  return entry;
}

/// Empty when there is no file; throws Error when it cannot be read.
std::optional<std::string> text_of_file(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (status.type() == fs::file_type::not_found) {
    return std::nullopt;
  }
  if (fs::is_regular_file(status) && fs::file_size(path, error) > kMaxBytes) {
    throw Error(fmt::format("{}: it is larger than any tuning file", path.string()));
  }
  return read_file_text(path, true);
}

/// The list of entries; throws Error if the document has another format.
Json entries_of(const std::string& text, const std::string& name) {
  const Json document = parse_json(text, name);
  if (!document.is_object() || document.value("kind", Json()) != kKind) {
    throw Error(fmt::format("{}: it is no tuning file, expected \"kind\": \"{}\"", name, kKind));
  }
  if (const Json format = document.value("format", Json()); format != kTuningFormat) {
    throw Error(
        fmt::format("{}: its format is {}, expected {}", name, quoted_json(format), kTuningFormat));
  }
  if (!document.contains("entries") || !document["entries"].is_array()) {
    throw Error(fmt::format("{}: it is damaged: there is no list of entries", name));
  }
  return document["entries"];
}

}  // namespace

std::optional<fs::path> default_tuning_path() {
  const auto absolute = [](const char* variable) -> std::optional<fs::path> {
    const char* value = std::getenv(variable);
    const fs::path path = value == nullptr ? fs::path() : fs::path(value);
    return path.is_absolute() ? std::optional(path) : std::nullopt;
  };
  // As the XDG base directory specification has it.
  std::optional<fs::path> folder = absolute("XDG_CONFIG_HOME");
  if (!folder) {
    folder = absolute("HOME");
    if (!folder) {
      return std::nullopt;
    }
    *folder /= ".config";
  }
  return *folder / "vantage" / "tuning.json";
}

TuningFileContent read_tuning_file(const fs::path& path) {
  TuningFileContent content;
  Json entries;
  try {
    const std::optional<std::string> text = text_of_file(path);
    if (!text) {
      return content;
    }
    entries = entries_of(*text, path.string());
  } catch (const Error& error) {
    content.warnings.push_back(error.what());
    content.is_foreign = true;
    return content;
  }
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const auto warn = [&](const std::string& what) {
      content.warnings.push_back(fmt::format("{}: entry {}: {}", path.string(), i + 1, what));
    };
    try {
      content.entries.push_back(entry_of(entries[i]));
    } catch (const Error& error) {
      warn(error.what());
    } catch (const Json::exception&) {
      warn("it is damaged: a field is missing or of a wrong kind");
    }
  }
  return content;
}

const TuningEntry* find_entry(const TuningFileContent& content, const TuningKey& key) {
  const auto found = std::ranges::find(content.entries, key, &TuningEntry::key);
  return found == content.entries.end() ? nullptr : &*found;
}

void store_entry(const fs::path& path, const TuningEntry& entry) {
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) {
    throw Error(fmt::format("{}: cannot create the folder: {}", folder.string(), error.message()));
  }
  const fs::path lock_file = folder / fmt::format(".{}.lock", path.filename().string());
  create_text_file(lock_file, "");
  const FileLock lock(lock_file, FileLock::Wait::kYes);  // keeps others from changing the file
  TuningFileContent content = read_tuning_file(path);
  if (content.is_foreign) {
    throw Error(fmt::format("{}; expected a tuning file or none, it is left as it is",
                            content.warnings.front()));
  }
  const auto old = std::ranges::find(content.entries, entry.key, &TuningEntry::key);
  if (old == content.entries.end()) {
    content.entries.push_back(entry);
  } else {
    old->match = entry.match ? entry.match : old->match;
    old->run = entry.run ? entry.run : old->run;
  }
  write_text_file(path, text_of(content.entries));
}

}  // namespace vantage
