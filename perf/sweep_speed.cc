// Speed of a movie: a sweep from the left camera to the right one, rendered and encoded as in
// `synth`, against rendering alone and encoding alone of the same frames. Prints a table; --json
// FILE writes the numbers.

#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "engine/io/video/video_io.h"
#include "engine/simd.h"
#include "engine/synthesis/view_synthesizer.h"
#include "perf/command_line.h"
#include "perf/figures.h"
#include "perf/stopwatch.h"
#include "perf/view_inputs.h"
#include "scheduler/frame_pipeline.h"

namespace vantage::perf {
namespace {

namespace fs = std::filesystem;

struct Settings {
  int width = 1920;
  int height = 1080;
  int frames = 300;
  int rounds = 3;
  int threads = scheduler::detect_machine().hardware_threads;
  std::string only;  ///< substring of the names of the positions to run; empty: all
  std::optional<std::string> json;
  fs::path output = fs::temp_directory_path();
};

/// A sweep of a view along the baseline, on its own threads.
class Sweep {
 public:
  Sweep(const SyntheticPair& pair, const ViewPlace& place, int frames, int threads)
      : pair_(pair),
        place_(place),
        frames_(frames),
        execution_({.threads = threads}),
        synthesizer_(SynthesisOptions{}, execution_),
        views_(static_cast<std::size_t>(threads) + 2) {
    fit_ = fit_channels(
        synthesizer_.intensity_sums({pair.left, pair.right, pair.maps.left.disparity_px.view(),
                                     pair.maps.right.disparity_px.view()},
                                    0.5),
        pair.left.channels(), 1);
  }

  /// Renders several views at a time, without output or to a video.
  FrameTime run(VideoWriter* video) {
    int next = 0;
    std::vector<int> index(views_.size());
    scheduler::FrameSteps steps;
    steps.read = [&](int slot) {
      index[static_cast<std::size_t>(slot)] = next;
      return next++ < frames_;
    };
    steps.prepare = [](int /*slot*/) {};
    steps.compute = [&](int slot) {
      render(index[static_cast<std::size_t>(slot)], views_[static_cast<std::size_t>(slot)]);
    };
    steps.encode = [](int /*slot*/) {};
    steps.write = [&](int slot) {
      if (video != nullptr) {
        video->write(views_[static_cast<std::size_t>(slot)].image);
      }
    };
    const Stopwatch watch;
    scheduler::run_frames(execution_.executor(), static_cast<int>(views_.size()), steps);
    if (video != nullptr) {
      video->finish();
    }
    return watch.per_frame(frames_);
  }

  /// Encoding only: times nothing but the encoder.
  FrameTime encode_only(VideoWriter& video) {
    FrameTime total;
    const auto timed = [&](const std::function<void()>& work) {
      const Stopwatch watch;
      work();
      const FrameTime time = watch.per_frame(frames_);
      total.wall += time.wall;
      total.processor += time.processor;
    };
    for (int frame = 0; frame < frames_; ++frame) {
      render(frame, views_.front());
      timed([&] { video.write(views_.front().image); });
    }
    timed([&] { video.finish(); });
    return total;
  }

 private:
  void render(int frame, SynthesizedView& view) const {
    ViewPlace place = place_;
    place.position.x = frames_ > 1 ? static_cast<double>(frame) / (frames_ - 1) : 0.5;
    synthesizer_.synthesize({pair_.left, pair_.right, pair_.maps.left.disparity_px.view(),
                             pair_.maps.right.disparity_px.view()},
                            place.view(pair_), view, &fit_);
  }

  const SyntheticPair& pair_;
  const ViewPlace& place_;
  int frames_;
  Execution execution_;
  ViewSynthesizer synthesizer_;
  std::array<IntensityFit, 4> fit_;
  std::vector<SynthesizedView> views_;
};

struct Contender {
  std::string name;
  std::function<FrameTime()> run;
  std::vector<FrameTime> rounds = {};
};

nlohmann::json time_place(const SyntheticPair& pair, const ViewPlace& place,
                          const Settings& settings) {
  Sweep one(pair, place, settings.frames, 1);
  Sweep all(pair, place, settings.frames, settings.threads);
  const fs::path file = settings.output / fmt::format("sweep_speed-{}.mp4", ::getpid());
  const auto with_video = [&](const std::function<FrameTime(VideoWriter&)>& run) {
    VideoWriter video(file, settings.width, settings.height, {});
    return run(video);
  };
  std::vector<Contender> contenders = {
      {"rendering, 1 thread", [&] { return one.run(nullptr); }},
      {fmt::format("rendering, {} threads", settings.threads), [&] { return all.run(nullptr); }},
      {"encoding, 1 thread",
       [&] { return with_video([&](VideoWriter& video) { return one.encode_only(video); }); }},
      {fmt::format("both, {} threads", settings.threads),
       [&] { return with_video([&](VideoWriter& video) { return all.run(&video); }); }}};
  for (int round = 0; round < settings.rounds; ++round) {
    for (Contender& contender : contenders) {
      contender.rounds.push_back(contender.run());
    }
  }
  const auto size = static_cast<double>(fs::file_size(file));
  fs::remove(file);
  const std::string title = fmt::format("{}x{}, {} views: {}, {:.1f} MB", settings.width,
                                        settings.height, settings.frames, place.name, 1e-6 * size);
  fmt::print("\n{}\n{:<26} {:>9} {:>9} {:>9} {:>9} {:>12}\n", title, "a view:", "least ms",
             "median ms", "CPU ms", "views/s", "to encoding");
  nlohmann::json rows = nlohmann::json::array();
  for (const Contender& contender : contenders) {
    const std::vector<double> wall = of(contender.rounds, &FrameTime::wall);
    const double processor = median(of(contender.rounds, &FrameTime::processor));
    const double ratio = median(ratios(contender.rounds, contenders[2].rounds));
    fmt::print("{:<26} {:>9.2f} {:>9.2f} {:>9.2f} {:>9.1f} {:>12.3f}\n", contender.name,
               1e3 * min(wall), 1e3 * median(wall), 1e3 * processor, 1 / median(wall), ratio);
    rows.push_back({{"name", contender.name},
                    {"least_seconds", min(wall)},
                    {"median_seconds", median(wall)},
                    {"processor_seconds", processor},
                    {"ratio_to_encoding", ratio}});
  }
  return {{"title", title}, {"rows", rows}};
}

int run_benchmark(int argc, char** argv) {
  CommandLine line("A sweep from camera to camera: rendering, encoding as H.264, and both at once");
  Settings settings;
  line.size(settings.width, settings.height);
  line.number("--frames", settings.frames, "Views of the sweep");
  line.rounds(settings.rounds);
  line.threads(settings.threads);
  line.only(settings.only, "Only positions whose names contain this");
  line.option("--output", settings.output, "Folder of the temporary videos");
  line.json(settings.json);
  line.parse(argc, argv);
  fmt::print("instruction set {}, {} threads\n", instruction_set_in_use(), settings.threads);
  Execution execution({.threads = settings.threads});
  const SyntheticPair pair = make_synthetic_pair(settings.width, settings.height, false, execution);
  nlohmann::json tables = nlohmann::json::array();
  for (const ViewPlace& place : view_places()) {
    if (place.position.x == 0.5 && place.name.find(settings.only) != std::string::npos) {
      tables.push_back(time_place(pair, place, settings));
    }
  }
  write_json(settings.json, tables);
  return 0;
}

}  // namespace
}  // namespace vantage::perf

int main(int argc, char** argv) { return vantage::perf::run_benchmark(argc, argv); }
