#include "apps/reports/run_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <fstream>

#include "apps/process/tell.h"
#include "apps/reports/remarks.h"
#include "apps/reports/trace_file.h"
#include "engine/build_info.h"
#include "engine/io/files/atomic_file.h"
#include "engine/options/emptied_value.h"
#include "engine/simd.h"
#include "engine/thread_placement.h"
#include "scheduler/trace_summary.h"

namespace vantage::apps {
namespace {

/// A memory figure of this process; 0 if the system does not provide it.
std::size_t process_bytes(std::string_view name) {
  std::ifstream status("/proc/self/status");
  for (std::string key; status >> key; std::getline(status, key)) {
    std::size_t kib = 0;
    if (key == name && status >> kib) {
      return kib * 1024;
    }
  }
  return 0;
}

/// Peak resident memory of this process. Not from getrusage(), whose figure starts with that of the
/// parent process.
std::size_t peak_memory_bytes() { return process_bytes("VmHWM:"); }

/// Milliseconds for short times, seconds for long ones.
std::string time_text(double seconds) {
  return seconds < 10 ? fmt::format("{:.1f} ms", seconds * 1e3) : fmt::format("{:.1f} s", seconds);
}

}  // namespace

RunReport::RunReport(std::string command, SettingValue settings)
    : command_(std::move(command)),
      settings_(std::move(settings)),
      bytes_at_start_(process_bytes("VmRSS:")) {}

RunReport::~RunReport() {
  for (SettingValue* value : {&settings_, &results_, &more_results_}) {
    empty_without_memory(*value);
  }
}

void RunReport::start_trace(const std::string& path) {
  if (!path.empty()) {
    trace_path_ = path;
    trace_ = std::make_unique<scheduler::Trace>();
  }
}

double RunReport::cells_per_second() const {
  return compute_seconds_ > 0 ? cells_ / compute_seconds_ : 0;
}

void RunReport::add_stage(std::string_view name, double seconds) {
  const auto known = std::ranges::find(stages_, name, &std::pair<std::string, double>::first);
  if (known != stages_.end()) {
    known->second += seconds;
  } else {
    stages_.emplace_back(name, seconds);
  }
}

void RunReport::add_match(const MatchReport& match) {
  for (const StageTime& stage : match.stages) {
    add_stage(stage.name, stage.seconds);
  }
  cells_ += match.cells;
  finest_cells_ += match.finest_cells;
  finest_pixels_ += match.finest_pixels;
  set_plan(match.plan);
  if (match.noise.kind != NoiseKind::kNone) {
    add_result("noise", noise_values(match.noise));
  }
}

void RunReport::set_plan(const scheduler::ChainPlan& plan) {
  SettingValue passes = SettingValue::array();
  for (const scheduler::PassPlan& pass : plan.passes) {
    passes.push_back({{"first_stage", pass.first_stage},
                      {"end_stage", pass.end_stage},
                      {"strip_width_px", pass.strip_columns},
                      {"band_height_px", pass.band_rows},
                      {"strips", pass.strips},
                      {"bands", pass.bands},
                      {"lag_rows", pass.lag_rows},
                      {"stored_rows", pass.stored_rows},
                      {"source_rows", pass.source_rows},
                      {"scratch_bytes", pass.scratch_bytes},
                      {"work_ratio", pass.work_ratio},
                      {"expected_time", pass.expected_time}});
  }
  plan_ = {{"steps", plan.steps},
           {"step_rows", plan.step_rows},
           {"stored_bytes", plan.stored_bytes},
           {"passes", passes}};
}

void RunReport::set_execution(Execution& execution) {
  isa_ = instruction_set_in_use();
  threads_ = execution.executor().thread_count();
  const scheduler::ThreadPlaces places =
      thread_places(execution.options(), scheduler::detect_topology());
  binding_ = {{"to", std::string(name_of(places.binding))},
              {"is_in_effect", places.system != nullptr},
              {"nodes", SettingValue::array()}};
  if (places.binding == scheduler::ThreadBinding::kNone) {
    places_summary_.clear();
    return;
  }
  for (const scheduler::NodeThreads& node : places.nodes) {
    binding_["nodes"].push_back({{"node", node.number}, {"threads", node.count()}});
  }
  places_summary_ =
      fmt::format(" on {} NUMA node{}{}", places.nodes.size(), places.nodes.size() == 1 ? "" : "s",
                  places.system == nullptr ? " (simulated, so not bound)" : "");
}

SettingValue RunReport::memory_json(std::size_t peak_bytes) const {
  MemoryUse memory = *memory_;
  memory.add("program", bytes_at_start_);
  std::size_t known_bytes = 0;
  for (const MemoryUse::Owner& owner : memory.owners) {
    known_bytes += owner.bytes;
  }
  memory.add("other", std::max(peak_bytes, known_bytes) - known_bytes);
  SettingValue owners = SettingValue::object();
  for (const MemoryUse::Owner& owner : memory.owners) {
    owners[owner.name] = owner.bytes;
  }
  return {{"owners", owners}};
}

SettingValue RunReport::json() const {
  const std::size_t peak_bytes = peak_memory_bytes();
  SettingValue stages = SettingValue::object();
  for (const auto& [name, seconds] : stages_) {
    stages[name] = seconds;
  }
  SettingValue document = {
      {"command", command_},
      {"version", build_info().version},
      {"settings", settings_},
      {"plan", plan_},
      {"isa", isa_},
      {"threads", threads_},
      {"seconds", {{"wall", wall_seconds()}, {"compute", compute_seconds_}, {"stages", stages}}},
      {"cells", cells_},
      {"cells_per_second", cells_per_second()},
      {"peak_memory_bytes", peak_bytes},
      {"warnings", warnings_},
      {"notes", notes_}};
  if (finest_pixels_ > 0) {
    document["candidates_per_pixel"] = finest_cells_ / finest_pixels_;
  }
  if (!binding_.is_null()) {
    document["binding"] = binding_;
  }
  if (memory_) {
    document["memory"] = memory_json(peak_bytes);
  }
  if (!tuning_.is_null()) {
    document["tuning"] = tuning_;
  }
  if (!trace_totals_.is_null()) {
    document["trace"] = trace_totals_;
  }
  if (!results_.is_null()) {
    document["results"] = results_;
  }
  for (const auto& [name, value] : more_results_.items()) {
    document["results"][name] = value;
  }
  return document;
}

void RunReport::write(const std::string& path) {
  if (trace_) {
    scheduler::TraceData trace = trace_->finish();
    trace_.reset();
    scheduler::add_waits(trace);
    write_trace(trace_path_, trace, command_);
    trace_totals_ = trace_report(scheduler::summarise(trace), waiting_causes(trace));
    trace_totals_["file"] = trace_path_;
  }
  if (!path.empty()) {
    // File names need not be UTF-8, JSON must be.
    write_text_file(path,
                    json().dump(2, ' ', false, SettingValue::error_handler_t::replace) + "\n");
  }
}

void RunReport::print_summary() const {
  std::string line = fmt::format("{}: {} thread{}{}, {};", command_, threads_,
                                 threads_ == 1 ? "" : "s", places_summary_, isa_);
  if (!tuning_summary_.empty()) {
    line += fmt::format(" {};", tuning_summary_);
  }
  for (const auto& [name, seconds] : stages_) {
    line += fmt::format(" {} {},", name, time_text(seconds));
  }
  line += " total " + time_text(wall_seconds());
  if (cells_ > 0) {
    line += fmt::format("; {:.0f} million cells/s", cells_per_second() * 1e-6);
  }
  tell("{}\n", line);
}

}  // namespace vantage::apps
