// Frames/s of the line on machines with other numbers of cores: simulates the pipeline of a run
// (frames in flight, reading and leaving in order, all else of many frames at a time) with the
// steps' processor times of a measurement. docs/SCALING.md says what was found and what the model
// leaves out. `--report` takes the file of `vantage run --report` or of `line_speed --json`.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <deque>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "engine/sequence/memory_plan.h"
#include "perf/command_line.h"

namespace vantage::perf {
namespace {

constexpr int kMaxDecoderThreads = 4;  ///< as in engine/io/video/video_reader.cc
constexpr int kWarmUp = 200;
constexpr int kFrames = 2000;  ///< with the warm-up

/// Reading: in the order of the frames, one at a time. All else, encoding of videos included: side
/// by side.
enum Step : std::uint8_t { kRead, kCompute, kStepCount };

/// Processor seconds of a frame.
using StepSeconds = std::array<double, kStepCount>;

struct Machine {
  int cores = 1;
  int in_flight = 1;
};

struct Prediction {
  double frames_per_second = 0;
  double cores_busy = 0;
  std::string limit = "frames in flight";
};

StepSeconds seconds_of(const nlohmann::json& steps, bool maps_only) {
  StepSeconds seconds{};
  for (const auto& [name, value] : steps.items()) {
    if (!maps_only || (name != "views" && name != "write")) {
      seconds[name == "read" ? kRead : kCompute] += value.get<double>();
    }
  }
  return seconds;
}

/// Every step under way has processor seconds left and a rate in cores; time goes from the end of
/// one step to the end of the next.
class Line {
 public:
  Line(const StepSeconds& seconds, const Machine& machine)
      : seconds_(seconds), machine_(machine), free_slots_(machine.in_flight) {}

  Prediction work() {
    double start = 0;
    while (written_ < kFrames) {
      start_steps();
      advance();
      if (written_ < kWarmUp) {
        start = now_;
        used_.fill(0);
        busy_ = 0;
      }
    }
    const double time = now_ - start;
    Prediction found{(kFrames - kWarmUp) / time, busy_ / (time * machine_.cores)};
    constexpr double kFull = 0.95;
    if (found.cores_busy > kFull) {
      found.limit = "cores";
    } else if (used_[kRead] > kFull * time) {
      found.limit = "reading";
    }
    return found;
  }

 private:
  struct Active {
    Step step;
    int frame;
    double left;
    double rate = 0;
  };

  [[nodiscard]] int count(Step step) const {
    return static_cast<int>(std::ranges::count(active_, step, &Active::step));
  }
  void start(Step step, int frame) {
    std::uniform_real_distribution<double> unequal(0.9, 1.1);  // frames differ
    active_.push_back({step, frame, seconds_[step] * unequal(random_)});
  }

  /// A thread takes a frame as far as its turn allows; then the next frame whose turn it is.
  void start_steps() {
    const auto thread_is_free = [&] { return std::ssize(active_) < machine_.cores; };
    for (; !read_.empty() && thread_is_free(); read_.pop_front()) {
      start(kCompute, read_.front());
    }
    if (thread_is_free() && count(kRead) == 0 && free_slots_ > 0) {
      --free_slots_;
      start(kRead, next_to_read_++);
    }
  }

  /// Decoders have threads of their own; loops of a frame take threads that have no frame.
  void set_rates() {
    const int decoders = std::clamp(machine_.cores / 2, 1, kMaxDecoderThreads);
    const int computing = count(kCompute);
    const int wanted = computing + decoders * count(kRead);
    const double idle = computing > 0 ? std::max(0, machine_.cores - wanted) : 0;
    const double cores = std::min<double>(machine_.cores, wanted + idle);
    const double share = cores / (wanted + idle);
    for (Active& active : active_) {
      active.rate = share * (active.step == kRead ? decoders : 1 + idle / computing);
    }
  }

  void advance() {
    set_rates();
    double time = std::numeric_limits<double>::infinity();
    for (const Active& active : active_) {
      time = std::min(time, active.left / active.rate);
    }
    now_ += time;
    for (Active& active : active_) {
      active.left -= active.rate * time;
      used_[active.step] += time;
      busy_ += active.rate * time;
    }
    std::erase_if(active_, [&](const Active& active) {
      constexpr double kRounding = 1e-12;
      const bool ends = active.left < kRounding;
      if (ends) {
        end(active);
      }
      return ends;
    });
  }

  void end(const Active& active) {
    if (active.step == kRead) {
      read_.push_back(active.frame);
      return;
    }
    // A frame keeps its place until all before it have left.
    for (computed_.insert(active.frame); computed_.erase(written_) > 0; ++written_) {
      ++free_slots_;
    }
  }

  StepSeconds seconds_;
  Machine machine_;
  int free_slots_;
  std::minstd_rand random_{1};
  std::vector<Active> active_;
  std::deque<int> read_;
  std::set<int> computed_;  // waiting for their turn
  int next_to_read_ = 0;
  int written_ = 0;
  double now_ = 0;
  StepSeconds used_{};  // time with the step under way
  double busy_ = 0;     // core seconds
};

/// The table of either program.
nlohmann::json steps_of_report(const nlohmann::json& report) {
  return report.contains("steps") ? report.at("steps")
                                  : report.at("results").at("processor_seconds_per_frame");
}

int run_model(int argc, char** argv) {
  CommandLine line("The line on 1 to 64 cores, simulated: frames/s, cores busy, the limit");
  std::string report;
  std::optional<int> in_flight;
  bool maps_only = false;
  line.option("--report", report, "Report of `vantage run` or `line_speed --json`");
  line.number("--in-flight", in_flight, "Frames in flight, instead of a run's default");
  line.flag("--maps-only", maps_only, "Without the view");
  line.parse(argc, argv);
  std::ifstream file(report);
  if (!file) {
    line.refuse(fmt::format("--report is '{}', expected a readable file", report));
  }
  const StepSeconds seconds = seconds_of(steps_of_report(nlohmann::json::parse(file)), maps_only);
  fmt::print("processor ms per frame: read {:.1f}, side by side {:.1f}\n", seconds[kRead] * 1e3,
             seconds[kCompute] * 1e3);
  fmt::print("{:>6} {:>10} {:>10} {:>6}  limit\n", "cores", "in flight", "frames/s", "busy");
  for (const int cores : {1, 2, 4, 8, 16, 32, 64}) {
    const Machine machine{.cores = cores,
                          .in_flight = in_flight.value_or(default_frames_in_flight(cores))};
    const Prediction found = Line(seconds, machine).work();
    fmt::print("{:>6} {:>10} {:>10.1f} {:>6.2f}  {}\n", machine.cores, machine.in_flight,
               found.frames_per_second, found.cores_busy, found.limit);
  }
  return 0;
}

}  // namespace
}  // namespace vantage::perf

int main(int argc, char** argv) { return vantage::perf::run_model(argc, argv); }
