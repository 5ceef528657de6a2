#include "apps/reports/trace_file.h"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <string_view>

#include "engine/build_info.h"
#include "engine/error.h"
#include "engine/io/files/atomic_file.h"
#include "engine/io/files/json_text.h"

namespace vantage::apps {
namespace {

constexpr int kProcess = 1;

std::string_view category(scheduler::SpanKind kind) {
  switch (kind) {
    case scheduler::SpanKind::kWork:
      return "work";
    case scheduler::SpanKind::kJoin:
      return "join";
    case scheduler::SpanKind::kWait:
      break;
  }
  return "wait";
}

double microseconds(std::int64_t ns) { return static_cast<double>(ns) * 1e-3; }

SettingValue arguments_of(const scheduler::SpanRecord& span, const scheduler::ThreadTrace& thread) {
  SettingValue arguments = SettingValue::object();
  const auto add = [&](const char* name, int value) {
    if (value >= 0) {
      arguments[name] = value;
    }
  };
  add("frame", span.place.frame);
  add("task", span.place.task);
  add("pass", span.place.pass);
  add("strip", span.place.strip);
  add("first_row", span.place.first_row);
  for (std::size_t k = 0; k < span.stage_count; ++k) {
    // A chain may have many stages of one name: iterations.
    const scheduler::StageShare& share = thread.stages[span.first_stage + k];
    SettingValue& stage = arguments["stages"][std::string(share.name)];
    if (stage.is_null()) {
      stage = {{"us", 0.0}, {"rows", 0}};
    }
    stage["us"] = stage["us"].get<double>() + microseconds(share.duration_ns);
    stage["rows"] = stage["rows"].get<int>() + share.rows;
  }
  return arguments;
}

SettingValue seconds_of(const std::map<std::string, scheduler::TraceSummary::Named>& names) {
  SettingValue values = SettingValue::object();
  for (const auto& [name, totals] : names) {
    values[name] = {{"seconds", totals.self_s},
                    {"processor_seconds", totals.processor_s},
                    {"count", totals.count}};
  }
  return values;
}

std::int64_t nanoseconds(const SettingValue& microseconds) {
  return std::llround(microseconds.get<double>() * 1e3);
}

scheduler::SpanKind kind_of(const std::string& category) {
  return category == "work"   ? scheduler::SpanKind::kWork
         : category == "join" ? scheduler::SpanKind::kJoin
                              : scheduler::SpanKind::kWait;
}

void add_event(const SettingValue& event, StoredTrace& stored) {
  const std::string& name = event.at("name").get_ref<const std::string&>();
  const SettingValue& arguments = event.at("args");
  if (name == "process_name" && event.at("ph") == "M") {
    return;
  }
  const auto thread_number = event.at("tid").get<std::size_t>();
  if (event.at("ph") == "M") {  // ahead of the spans of its thread
    stored.trace.threads.push_back(
        {arguments.at("name").get<std::string>(), arguments.at("in_pool").get<bool>(), {}, {}});
    return;
  }
  if (thread_number < 1 || thread_number > stored.trace.threads.size()) {
    return;  // of no thread that it names
  }
  scheduler::SpanRecord span;
  span.name = *stored.names.insert(name).first;
  span.kind = kind_of(event.at("cat"));
  span.begin_ns = nanoseconds(event.at("ts"));
  span.end_ns = span.begin_ns + nanoseconds(event.at("dur"));
  span.place.frame = arguments.value("frame", -1);
  stored.trace.threads[thread_number - 1].spans.push_back(span);
}

}  // namespace

void write_trace(const std::string& path, const scheduler::TraceData& trace,
                 const std::string& command) {
  AtomicFile file(path);
  std::ofstream out(file.temporary_path(), std::ios::binary);
  const SettingValue about = {{"command", command},
                              {"version", build_info().version},
                              {"wall_us", microseconds(trace.wall_ns)},
                              {"dropped_spans", trace.dropped_spans}};
  out << R"({"displayTimeUnit": "ms", "otherData": )" << about.dump() << ", \"traceEvents\": [\n";
  const SettingValue process = {{"ph", "M"},
                                {"name", "process_name"},
                                {"pid", kProcess},
                                {"args", {{"name", "vantage " + command}}}};
  out << process.dump();
  for (std::size_t t = 0; t < trace.threads.size(); ++t) {
    const scheduler::ThreadTrace& thread = trace.threads[t];
    const SettingValue name = {{"ph", "M"},
                               {"name", "thread_name"},
                               {"pid", kProcess},
                               {"tid", t + 1},
                               {"args", {{"name", thread.name}, {"in_pool", thread.is_in_pool}}}};
    out << ",\n" << name.dump();
    for (const scheduler::SpanRecord& span : thread.spans) {
      const SettingValue event = {{"ph", "X"},
                                  {"name", std::string(span.name)},
                                  {"cat", std::string(category(span.kind))},
                                  {"pid", kProcess},
                                  {"tid", t + 1},
                                  {"ts", microseconds(span.begin_ns)},
                                  {"dur", microseconds(span.end_ns - span.begin_ns)},
                                  {"args", arguments_of(span, thread)}};
      out << ",\n" << event.dump();
    }
  }
  out << "\n]}\n";
  out.close();
  if (!out) {
    throw Error(fmt::format("{}: cannot be written", path));
  }
  file.commit();
}

StoredTrace read_trace(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  StoredTrace stored;
  std::string line;
  try {
    std::getline(file, line);
    const SettingValue head = parse_json(line + "]}", path);
    stored.trace.wall_ns = nanoseconds(head.at("otherData").at("wall_us"));
    stored.trace.dropped_spans = head.at("otherData").at("dropped_spans");
    while (std::getline(file, line) && line != "]}") {  // an event a line
      line.erase(line.find_last_not_of(',') + 1);
      add_event(parse_json(line, path), stored);
    }
  } catch (const SettingValue::exception&) {
    throw Error(fmt::format("{}: cannot be read, expected a trace of vantage", path));
  }
  if (line != "]}") {
    throw Error(fmt::format("{}: its end is missing, expected a trace of vantage", path));
  }
  return stored;
}

SettingValue trace_report(const scheduler::TraceSummary& summary, const WaitingCauses& causes) {
  SettingValue threads = SettingValue::array();
  for (const scheduler::TraceSummary::Thread& thread : summary.threads) {
    threads.push_back({{"name", thread.name},
                       {"is_in_pool", thread.is_in_pool},
                       {"work_seconds", thread.work_s},
                       {"wait_seconds", thread.wait_s}});
  }
  SettingValue stages = SettingValue::object();
  for (const auto& [name, stage] : summary.stages) {
    stages[name] = {{"seconds", stage.seconds},
                    {"columns", stage.columns},
                    {"own_columns", stage.own_columns},
                    {"cells", stage.work.cells},
                    {"operations", stage.work.operations},
                    {"bytes", stage.work.bytes}};
  }
  SettingValue frames = SettingValue::array();
  for (const auto& [frame, seconds] : summary.frame_work_s) {
    if (frame >= 0) {
      frames.push_back({{"frame", frame}, {"work_seconds", seconds}});
    }
  }
  return {{"wall_seconds", summary.wall_s},
          {"work_share", summary.work_share()},
          {"threads", threads},
          {"work", seconds_of(summary.work)},
          {"waits", seconds_of(summary.waits)},
          {"waiting_for",
           {{"reading", causes.reading_s},
            {"computing", causes.computing_s},
            {"writing", causes.writing_s},
            {"nothing", causes.nothing_s}}},
          {"stages", stages},
          {"frames", frames}};
}

}  // namespace vantage::apps
