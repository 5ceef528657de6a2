#include "engine/profiling/profile_json.h"

#include <fmt/format.h>

#include <concepts>
#include <type_traits>

#include "engine/error.h"
#include "engine/io/files/json_text.h"
#include "engine/profiling/profile_figures.h"
#include "engine/profiling/profile_findings.h"
#include "engine/profiling/roofline.h"
#include "engine/profiling/stage_figures.h"

namespace vantage {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kSchema = 1;
constexpr const char* kSchemaKey = "profile_schema";

template <typename T, typename Struct>
concept Maybe = std::same_as<std::remove_const_t<T>, Struct>;

// The one list of the fields of each struct, for writing and reading: calls visit(key, field).

template <Maybe<ProfileSample> T, typename Visit>
void visit_fields(T& sample, const Visit& visit) {
  visit("median", sample.median);
  visit("least", sample.min);
  visit("most", sample.max);
}

template <Maybe<StageProfile> T, typename Visit>
void visit_fields(T& stage, const Visit& visit) {
  visit("name", stage.name);
  visit("seconds", stage.seconds);
  visit("columns", stage.columns);
  visit("own_columns", stage.own_columns);
  visit("cells", stage.cells);
  visit("operations", stage.operations);
  visit("bytes", stage.bytes);
}

template <Maybe<PartProfile> T, typename Visit>
void visit_fields(T& part, const Visit& visit) {
  visit("name", part.name);
  visit("seconds", part.seconds);
  visit("count", part.count);
}

template <Maybe<ThreadProfile> T, typename Visit>
void visit_fields(T& thread, const Visit& visit) {
  visit("name", thread.name);
  visit("is_in_pool", thread.is_in_pool);
  visit("work_s", thread.work_s);
  visit("wait_s", thread.wait_s);
}

template <Maybe<WaitingProfile> T, typename Visit>
void visit_fields(T& waiting, const Visit& visit) {
  visit("reading_s", waiting.reading_s);
  visit("computing_s", waiting.computing_s);
  visit("writing_s", waiting.writing_s);
  visit("nothing_s", waiting.nothing_s);
}

template <Maybe<TimelineSpan> T, typename Visit>
void visit_fields(T& span, const Visit& visit) {
  visit("name", span.name);
  visit("is_wait", span.is_wait);
  visit("begin_s", span.begin_s);
  visit("end_s", span.end_s);
  visit("frame", span.frame);
}

template <Maybe<TimelineRow> T, typename Visit>
void visit_fields(T& row, const Visit& visit) {
  visit("thread", row.thread);
  visit("is_in_pool", row.is_in_pool);
  visit("spans", row.spans);
}

template <Maybe<ThreadCountProfile> T, typename Visit>
void visit_fields(T& count, const Visit& visit) {
  visit("threads", count.threads);
  visit("runs", count.runs);
  visit("wall_s", count.wall_s);
  visit("compute_s", count.compute_s);
  visit("cells_per_s", count.cells_per_s);
  visit("frames_per_s", count.frames_per_s);
  visit("work_share", count.work_share);
  visit("peak_memory_bytes", count.peak_memory_bytes);
  visit("imbalance", count.imbalance);
  visit("stages", count.stages);
  visit("parts", count.parts);
  visit("waits", count.waits);
  visit("waiting_for", count.waiting_for);
  visit("workers", count.workers);
}

template <Maybe<SpeedUp> T, typename Visit>
void visit_fields(T& speed_up, const Visit& visit) {
  visit("threads", speed_up.threads);
  visit("ratio", speed_up.ratio);
  visit("efficiency", speed_up.efficiency);
  visit("serial_fraction", speed_up.serial_fraction);
}

template <Maybe<MachineCeilings> T, typename Visit>
void visit_fields(T& ceilings, const Visit& visit) {
  visit("threads", ceilings.threads);
  visit("core_gflops", ceilings.core_gflops);
  visit("all_gflops", ceilings.all_gflops);
  visit("core_l2_gb_per_s", ceilings.core_l2_gb_per_s);
  visit("all_l2_gb_per_s", ceilings.all_l2_gb_per_s);
  visit("core_memory_gb_per_s", ceilings.core_memory_gb_per_s);
  visit("all_memory_gb_per_s", ceilings.all_memory_gb_per_s);
}

template <Maybe<ThreadRoofs> T, typename Visit>
void visit_fields(T& roofs, const Visit& visit) {
  visit("gflops", roofs.gflops);
  visit("l2_gb_per_s", roofs.l2_gb_per_s);
  visit("memory_gb_per_s", roofs.memory_gb_per_s);
}

template <Maybe<MemoryOwner> T, typename Visit>
void visit_fields(T& owner, const Visit& visit) {
  visit("name", owner.name);
  visit("bytes", owner.bytes);
}

template <Maybe<HardwareCounts> T, typename Visit>
void visit_fields(T& hardware, const Visit& visit) {
  visit("counts", hardware.counts);
  visit("absence", hardware.absence);
}

template <Maybe<Profile> T, typename Visit>
void visit_fields(T& profile, const Visit& visit) {
  visit("version", profile.version);
  visit("command", profile.command);
  visit("date", profile.date);
  visit("processor", profile.processor);
  visit("isa", profile.isa);
  visit("hardware_threads", profile.hardware_threads);
  visit("peak_memory_bytes", profile.peak_memory_bytes);
  visit("ceilings", profile.ceilings);
  visit("thread_counts", profile.thread_counts);
  visit("speed_ups", profile.speed_ups);
  visit("serial_fraction", profile.serial_fraction);
  visit("memory", profile.memory);
  visit("hardware", profile.hardware);
  visit("timeline_s", profile.timeline_s);
  visit("timeline", profile.timeline);
}

// Conversion to JSON.

template <typename T>
requires std::is_arithmetic_v<T> || std::same_as<T, std::string> Json to_value(const T& value) {
  return value;
}

template <typename T>
requires std::is_class_v<T> &&(!std::same_as<T, std::string>)Json to_value(const T& value);

template <typename T>
Json to_value(const std::optional<T>& value) {
  return value ? to_value(*value) : Json();
}

template <typename T>
Json to_value(const std::vector<T>& values) {
  Json list = Json::array();
  for (const T& value : values) {
    list.push_back(to_value(value));
  }
  return list;
}

template <typename T>
Json to_value(const std::map<std::string, T>& values) {
  Json object = Json::object();
  for (const auto& [name, value] : values) {
    object[name] = to_value(value);
  }
  return object;
}

template <typename T>
requires std::is_class_v<T> &&(!std::same_as<T, std::string>)Json to_value(const T& value) {
  Json object = Json::object();
  visit_fields(value, [&](const char* key, const auto& field) { object[key] = to_value(field); });
  return object;
}

// Derived values for display. They are not read back.

Json roofline_of(const StageProfile& stage, const std::optional<ThreadRoofs>& roofs) {
  const auto place = roofs ? place_on_roofline(stage, *roofs) : std::nullopt;
  if (!place) {
    return {};
  }
  return {{"operations_per_byte", place->operations_per_byte},
          {"roof", place->roof == Roof::kArithmetic ? "arithmetic" : "level 2"},
          {"roof_gflops", place->roof_gflops},
          {"roof_share", place->roof_share},
          {"memory_share", place->memory_share}};
}

void add_figures(const Profile& profile, const ThreadCountProfile& count, Json& value) {
  const std::optional<ThreadRoofs> roofs = roofs_on(profile, count.threads);
  value["pool_work_s"] = pool_work_s(count);
  value["pool_time_s"] = pool_time_s(count);
  value["roofs"] = to_value(roofs);
  for (std::size_t i = 0; i < count.stages.size(); ++i) {
    const StageProfile& stage = count.stages[i];
    value["stages"][i].update({{"work_share", work_share(stage, count)},
                               {"ns_per_cell", nanoseconds_per_cell(stage)},
                               {"cells_per_s", cells_per_second(stage)},
                               {"halo_share", halo_share(stage)},
                               {"gb_per_s", gb_per_second(stage)},
                               {"gflops", gflops(stage)},
                               {"roofline", roofline_of(stage, roofs)}});
  }
}

void add_figures(const Profile& profile, Json& document) {
  for (std::size_t i = 0; i < profile.thread_counts.size(); ++i) {
    add_figures(profile, profile.thread_counts[i], document["thread_counts"][i]);
  }
  document["hardware"]["instructions_per_cycle"] =
      to_value(instructions_per_cycle(profile.hardware));
  document["advice"] = profile.advice;
  document["findings"] = Json::array();
  for (const ProfileFinding& finding : profile_findings(profile)) {
    document["findings"].push_back(finding.text);
  }
}

// Conversion from JSON; `where` names the value in messages.

[[noreturn]] void reject(const std::string& where, std::string_view expected) {
  throw Error(fmt::format("{} is missing or wrong, expected {}", where, expected));
}

void take(const Json& value, const std::string& where, std::string& field) {
  if (!value.is_string()) {
    reject(where, "a text");
  }
  field = value.get<std::string>();
}

void take(const Json& value, const std::string& where, bool& field) {
  if (!value.is_boolean()) {
    reject(where, "true or false");
  }
  field = value.get<bool>();
}

void take(const Json& value, const std::string& where, double& field) {
  if (!value.is_number()) {
    reject(where, "a number");
  }
  field = value.get<double>();
}

template <std::integral T>
void take(const Json& value, const std::string& where, T& field) {
  if (!value.is_number_integer()) {
    reject(where, "a whole number");
  }
  field = value.get<T>();
}

template <typename T>
requires std::is_class_v<T> &&
    (!std::same_as<T, std::string>)void take(const Json& value, const std::string& where, T& field);

template <typename T>
void take(const Json& value, const std::string& where, std::optional<T>& field) {
  if (value.is_null()) {
    field.reset();
  } else {
    take(value, where, field.emplace());
  }
}

template <typename T>
void take(const Json& value, const std::string& where, std::vector<T>& field) {
  if (!value.is_array()) {
    reject(where, "a list");
  }
  field.clear();
  for (const Json& member : value) {
    const std::string member_name = fmt::format("{}[{}]", where, field.size());
    take(member, member_name, field.emplace_back());
  }
}

template <typename T>
void take(const Json& value, const std::string& where, std::map<std::string, T>& field) {
  if (!value.is_object()) {
    reject(where, "an object");
  }
  field.clear();
  for (const auto& [key, member] : value.items()) {
    take(member, where + "." + key, field[key]);
  }
}

template <typename T>
requires std::is_class_v<T> &&
    (!std::same_as<T, std::string>)void take(const Json& value, const std::string& where,
                                             T& field) {
  if (!value.is_object()) {
    reject(where, "an object");
  }
  visit_fields(field, [&](const char* key, auto& member) {
    const auto found = value.find(key);
    const std::string member_name = where.empty() ? std::string(key) : where + "." + key;
    take(found == value.end() ? Json(Json::value_t::discarded) : *found, member_name, member);
  });
}

}  // namespace

std::string profile_json(const Profile& profile) {
  Json document = {{kSchemaKey, kSchema}};
  document.update(to_value(profile));
  add_figures(profile, document);
  // File names may be invalid UTF-8; JSON must be valid.
  return document.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

Profile read_profile(const std::string& path) {
  const Json document = read_json_file(path);
  if (!document.is_object() || !document.contains(kSchemaKey)) {
    throw Error(fmt::format("{}: is no profile, expected what 'profile' wrote with `json`", path));
  }
  if (document.at(kSchemaKey) != kSchema) {
    throw Error(
        fmt::format("{}: {} is {}, expected {}: another version of vantage wrote it, profile again "
                    "with this one",
                    path, kSchemaKey, quoted_json(document.at(kSchemaKey)), kSchema));
  }
  Profile profile;
  try {
    take(document, "", profile);
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", path, error.what()));
  }
  return profile;
}

}  // namespace vantage
