#include "engine/profiling/profile_json.h"

#include <nlohmann/json.hpp>

#include "engine/profiling/profile_figures.h"
#include "engine/profiling/profile_findings.h"
#include "engine/profiling/roofline.h"
#include "engine/profiling/stage_figures.h"

namespace vantage {

using ProfileJson = nlohmann::ordered_json;

template <typename T>
static ProfileJson value_or_null(const std::optional<T>& value) {
  return value ? ProfileJson(*value) : ProfileJson();
}

// By these functions nlohmann::json writes the structs, alone, in lists and in maps.

static void to_json(ProfileJson& json, const ProfileSample& sample) {
  json = {{"median", sample.median}, {"least", sample.min}, {"most", sample.max}};
}

static void to_json(ProfileJson& json, const StageProfile& stage) {
  json = {{"name", stage.name},       {"seconds", stage.seconds},
          {"columns", stage.columns}, {"own_columns", stage.own_columns},
          {"cells", stage.cells},     {"operations", stage.operations},
          {"bytes", stage.bytes}};
}

static void to_json(ProfileJson& json, const PartProfile& part) {
  json = {{"name", part.name},
          {"seconds", part.seconds},
          {"processor_s", part.processor_s},
          {"count", part.count}};
}

static void to_json(ProfileJson& json, const ThreadProfile& thread) {
  json = {{"name", thread.name},
          {"is_in_pool", thread.is_in_pool},
          {"work_s", thread.work_s},
          {"wait_s", thread.wait_s}};
}

static void to_json(ProfileJson& json, const WaitingProfile& waiting) {
  json = {{"reading_s", waiting.reading_s},
          {"computing_s", waiting.computing_s},
          {"writing_s", waiting.writing_s},
          {"nothing_s", waiting.nothing_s}};
}

static void to_json(ProfileJson& json, const TimelineSpan& span) {
  json = {{"name", span.name},
          {"is_wait", span.is_wait},
          {"begin_s", span.begin_s},
          {"end_s", span.end_s},
          {"frame", span.frame}};
}

static void to_json(ProfileJson& json, const TimelineRow& row) {
  json = {{"thread", row.thread}, {"is_in_pool", row.is_in_pool}, {"spans", row.spans}};
}

static void to_json(ProfileJson& json, const ThreadCountProfile& count) {
  json = {{"threads", count.threads},
          {"runs", count.runs},
          {"wall_s", count.wall_s},
          {"compute_s", count.compute_s},
          {"cells_per_s", count.cells_per_s},
          {"frames_per_s", count.frames_per_s},
          {"work_share", count.work_share},
          {"peak_memory_bytes", count.peak_memory_bytes},
          {"imbalance", count.imbalance},
          {"frames", count.frames},
          {"frame_steps", count.frame_steps},
          {"stages", count.stages},
          {"parts", count.parts},
          {"waits", count.waits},
          {"waiting_for", count.waiting_for},
          {"workers", count.workers}};
}

static void to_json(ProfileJson& json, const SpeedUp& speed_up) {
  json = {{"threads", speed_up.threads},
          {"ratio", speed_up.ratio},
          {"efficiency", speed_up.efficiency},
          {"serial_fraction", value_or_null(speed_up.serial_fraction)}};
}

static void to_json(ProfileJson& json, const MachineCeilings& ceilings) {
  json = {{"threads", ceilings.threads},
          {"core_gflops", ceilings.core_gflops},
          {"all_gflops", ceilings.all_gflops},
          {"core_l2_gb_per_s", ceilings.core_l2_gb_per_s},
          {"all_l2_gb_per_s", ceilings.all_l2_gb_per_s},
          {"core_memory_gb_per_s", ceilings.core_memory_gb_per_s},
          {"all_memory_gb_per_s", ceilings.all_memory_gb_per_s}};
}

static void to_json(ProfileJson& json, const ThreadRoofs& roofs) {
  json = {{"gflops", roofs.gflops},
          {"l2_gb_per_s", roofs.l2_gb_per_s},
          {"memory_gb_per_s", roofs.memory_gb_per_s}};
}

static void to_json(ProfileJson& json, const MemoryOwner& owner) {
  json = {{"name", owner.name}, {"bytes", owner.bytes}};
}

static void to_json(ProfileJson& json, const Profile& profile) {
  constexpr int kSchema = 1;
  json = {{"profile_schema", kSchema},
          {"version", profile.version},
          {"command", profile.command},
          {"date", profile.date},
          {"processor", profile.processor},
          {"isa", profile.isa},
          {"hardware_threads", profile.hardware_threads},
          {"peak_memory_bytes", profile.peak_memory_bytes},
          {"ceilings", profile.ceilings},
          {"thread_counts", profile.thread_counts},
          {"speed_ups", profile.speed_ups},
          {"serial_fraction", value_or_null(profile.serial_fraction)},
          {"memory", profile.memory},
          {"timeline_s", profile.timeline_s},
          {"timeline", profile.timeline}};
}

namespace {

// Derived values for display.

ProfileJson roofline_of(const StageProfile& stage, const std::optional<ThreadRoofs>& roofs) {
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

void add_figures(const Profile& profile, const ThreadCountProfile& count, ProfileJson& value) {
  const std::optional<ThreadRoofs> roofs = roofs_on(profile, count.threads);
  value["pool_work_s"] = pool_work_s(count);
  value["pool_time_s"] = pool_time_s(count);
  value["roofs"] = value_or_null(roofs);
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

void add_figures(const Profile& profile, ProfileJson& document) {
  for (std::size_t i = 0; i < profile.thread_counts.size(); ++i) {
    add_figures(profile, profile.thread_counts[i], document["thread_counts"][i]);
  }
  document["processor_growth"] = ProfileJson::array();
  for (const ProcessorGrowth& one : processor_growth(profile)) {
    document["processor_growth"].push_back(
        {{"name", one.name}, {"kind", one.kind}, {"ms", one.ms}, {"growth", one.growth}});
  }
  document["advice"] = profile.advice;
  document["findings"] = ProfileJson::array();
  for (const ProfileFinding& finding : profile_findings(profile)) {
    document["findings"].push_back(finding.text);
  }
}

}  // namespace

std::string profile_json(const Profile& profile) {
  ProfileJson document = profile;
  add_figures(profile, document);
  // File names may be invalid UTF-8; JSON must be valid.
  return document.dump(1, ' ', false, ProfileJson::error_handler_t::replace) + "\n";
}

}  // namespace vantage
