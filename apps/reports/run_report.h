#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "engine/execution.h"
#include "engine/image/memory_use.h"
#include "engine/matching/stereo_matcher.h"
#include "engine/options/setting_value.h"
#include "engine/remark.h"
#include "engine/seconds_since.h"
#include "scheduler/strip_plan.h"
#include "scheduler/trace.h"

namespace vantage::apps {

/// What a command did and how long it took: the JSON of --report and the summary on stderr. Wall
/// time counts from its construction.
class RunReport {
 public:
  RunReport(std::string command, SettingValue settings);
  RunReport(const RunReport&) = delete;
  RunReport& operator=(const RunReport&) = delete;
  ~RunReport();
  [[nodiscard]] const std::string& command() const { return command_; }
  /// Replaces the settings, for example after an input has determined some.
  void set_settings(SettingValue settings) { settings_ = std::move(settings); }

  /// Records a trace from here to write(); an empty path: none.
  void start_trace(const std::string& path);

  /// Runs `work` as a stage of compute time and returns its result. Names of stages must have
  /// static storage.
  template <typename Work>
  auto timed_compute(std::string_view name, const Work& work) {
    const scheduler::Span span(name);
    return timed(work, [&](double seconds) {
      add_stage(name, seconds);
      add_compute_seconds(seconds);
    });
  }
  /// Runs `work`, which reports its stages itself.
  template <typename Work>
  auto timed_compute(const Work& work) {
    return timed(work, [&](double seconds) { add_compute_seconds(seconds); });
  }
  /// Runs `work` as a stage that is not compute time because it reads or writes files.
  template <typename Work>
  auto timed_file_access(std::string_view name, const Work& work) {
    const scheduler::Span span(name);
    return timed(work, [&](double seconds) { add_stage(name, seconds); });
  }

  /// Times of the same name are added.
  void add_stage(std::string_view name, double seconds);
  void add_compute_seconds(double seconds) { compute_seconds_ += seconds; }
  void add_cells(double cells) { cells_ += cells; }
  /// Stages, cells and plan of a match; its compute time is not added.
  void add_match(const MatchReport& match);
  void set_plan(const scheduler::ChainPlan& plan);
  /// Threads, where they run (key `binding`), and instruction set.
  void set_execution(Execution& execution);
  /// The tuned settings in use, or why there are none, under the key `tuning`; `summary` is printed
  /// to stderr.
  void set_tuning(SettingValue tuning, std::string summary) {
    tuning_ = std::move(tuning);
    tuning_summary_ = std::move(summary);
  }
  /// Memory use under the key `memory`: by owner, at the start of the command, and other memory at
  /// the peak.
  void set_memory(MemoryUse memory) { memory_ = std::move(memory); }
  /// Command-specific findings under the key `results`.
  void set_results(SettingValue results) { results_ = std::move(results); }
  /// Texts under the keys `warnings` and `notes`.
  void add_remark(const Remark& remark) {
    (remark.is_warning() ? warnings_ : notes_).push_back(remark.text);
  }
  /// Another finding, which set_results() does not replace.
  void add_result(const std::string& name, SettingValue value) {
    more_results_[name] = std::move(value);
  }

  /// Seconds since this object was created.
  [[nodiscard]] double wall_seconds() const { return seconds_since(start_); }

  /// The JSON document of --report.
  [[nodiscard]] SettingValue json() const;
  /// Writes the trace, then json() to `path`, each whole or not at all; nothing for an empty path.
  void write(const std::string& path);
  /// One line on stderr: threads, stages, total, cells per second.
  void print_summary() const;

 private:
  using Clock = std::chrono::steady_clock;

  template <typename Work, typename Record>
  static auto timed(const Work& work, const Record& record) {
    const Clock::time_point start = Clock::now();
    if constexpr (std::is_void_v<decltype(work())>) {
      work();
      record(seconds_since(start));
    } else {
      auto result = work();
      record(seconds_since(start));
      return result;
    }
  }
  [[nodiscard]] double cells_per_second() const;
  [[nodiscard]] SettingValue memory_json(std::size_t peak_bytes) const;

  std::string command_;
  SettingValue settings_;
  Clock::time_point start_ = Clock::now();
  std::size_t bytes_at_start_;
  SettingValue plan_;
  std::string trace_path_;
  std::unique_ptr<scheduler::Trace> trace_;  // null: none is recorded
  SettingValue trace_totals_;
  SettingValue tuning_;
  std::string tuning_summary_;
  std::optional<MemoryUse> memory_;
  SettingValue warnings_ = SettingValue::array();
  SettingValue notes_ = SettingValue::array();
  SettingValue results_;
  SettingValue more_results_ = SettingValue::object();
  std::string isa_;
  int threads_ = 0;
  SettingValue binding_;
  std::string places_summary_;  // of the threads; empty where they are not bound
  double compute_seconds_ = 0;
  double cells_ = 0;
  double finest_cells_ = 0;   ///< see MatchReport
  double finest_pixels_ = 0;  ///< 0: not known
  std::vector<std::pair<std::string, double>> stages_;
};

}  // namespace vantage::apps
