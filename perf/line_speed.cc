// Speed of the whole line: H.264 side by side in, both maps as 16-bit PNG and a view as H.264 out,
// of a generated moving scene, beside the loop of an OpenCV user, interleaved in one run. Prints
// frames/s, core-seconds and what each step costs; --json FILE writes the numbers.

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "engine/matching/options/method_names.h"
#include "engine/simd.h"
#include "perf/command_line.h"
#include "perf/figures.h"
#include "perf/sequence_inputs.h"
#include "perf/sequence_timing.h"

namespace vantage::perf {
namespace {

namespace fs = std::filesystem;

constexpr int kVideoFrames = 32;
/// A chunk is longer than a run, so that its videos end after the clock.
constexpr int kChunkFrames = 1000;

struct Settings {
  int width = 1920;
  int height = 1080;
  int disparities = 128;
  std::string preset = "fast";
  int frames = 40;  ///< after the warm-up
  int rounds = 3;
  int threads = scheduler::detect_machine().hardware_threads;
  std::optional<int> in_flight;
  std::optional<fs::path> folder;  ///< keeps the generated video for the next run
  std::optional<std::string> json;
};

/// A camera that moves sideways before moving objects. The file is made once.
SequenceInputs generate_video(const Settings& settings, const fs::path& folder) {
  const fs::path file =
      folder / fmt::format("{}x{}x{}.mp4", settings.width, settings.height, settings.disparities);
  SequenceInputs inputs;
  inputs.name = file.stem();
  inputs.video_file = file;
  inputs.video.stereo = file.string();
  inputs.video.packing = StereoPacking{};
  if (fs::exists(file)) {
    return inputs;
  }
  LayeredSceneOptions options;
  options.width_px = settings.width;
  options.height_px = settings.height;
  options.samples_per_side = 1;
  options.near_disparity_px = 0.95 * settings.disparities;
  options.far_disparity_px = 0.1 * settings.disparities;
  options.noise_sigma = 1;
  Execution execution({});
  const LayeredScene scene(options, execution);
  VideoWriter writer(file, 2 * options.width_px, options.height_px, {});
  Photograph packed;
  for (int frame = 0; frame < kVideoFrames; ++frame) {
    constexpr double kStepInBaselines = 0.02;
    const double x = kStepInBaselines * frame;
    pack_stereo(scene.render({x, 0}, frame).image, scene.render({x + 1, 0}, frame).image, {},
                packed);
    writer.write(packed);
  }
  writer.finish();
  return inputs;
}

SequenceOptions line_options(const Settings& settings, MatchPreset preset) {
  SequenceOptions options;
  options.match.preset = preset;
  options.match.disparities = {0, settings.disparities - 1};
  options.save = {SequenceOutput::kDisparity, SequenceOutput::kRightDisparity,
                  SequenceOutput::kViews};
  options.map_format = "png";
  options.video = {SequenceOutput::kViews};
  options.views = {ViewPath::fixed(BaselinePosition{0.5, 0})};
  options.chunk_frames = kChunkFrames;
  return options;
}

/// The median over the rounds of the processor time of all cores' time.
double share_busy(const std::vector<FrameTime>& rounds, int threads) {
  std::vector<double> shares;
  for (const FrameTime& round : rounds) {
    shares.push_back(round.processor / (round.wall * threads));
  }
  return median(shares);
}

nlohmann::json print_row(const std::string& name, const std::vector<FrameTime>& rounds,
                         const std::vector<FrameTime>& peer, int threads) {
  const double wall = median(of(rounds, &FrameTime::wall));
  const double processor = median(of(rounds, &FrameTime::processor));
  const double busy = share_busy(rounds, threads);
  const std::vector<double> ratio = ratios(rounds, peer);
  fmt::print("{:<26} {:>9.2f} {:>14.1f} {:>14.3f} {:>12.3f} {:>18}\n", name, 1 / wall, wall * 1e3,
             processor, busy, with_range(ratio));
  return {{"name", name},           {"frames_per_second", 1 / wall},
          {"median_seconds", wall}, {"core_seconds", processor},
          {"share_busy", busy},     {"ratio_to_opencv", figures(ratio)}};
}

nlohmann::json measure(const Settings& settings, MatchPreset preset, const fs::path& folder) {
  const SequenceInputs inputs = generate_video(settings, folder);
  const SequenceOptions options = line_options(settings, preset);
  const int frames = kWarmUpFrames + settings.frames + 1;
  const fs::path results = folder / fmt::format("line_speed-{}", ::getpid());
  std::vector<FrameTime> ours;
  std::vector<FrameTime> opencv;
  SequenceReport report;
  for (int round = 0; round < settings.rounds; ++round) {
    RunTiming timing = time_run(inputs.video, options, frames, settings.threads,
                                settings.in_flight.value_or(settings.threads + 2), results / "run");
    ours.push_back(timing.frame);
    report = std::move(timing.report);
    constexpr int kOpenCvFrames = 9;
    opencv.push_back(time_opencv(inputs, options.match.disparities, true, kOpenCvFrames,
                                 settings.threads, results / "opencv"));
  }
  fs::remove_all(results);
  const std::string title = fmt::format("{}x{}, {} candidates, {} threads, {} frames of {} rounds",
                                        settings.width, settings.height, settings.disparities,
                                        settings.threads, settings.frames, settings.rounds);
  fmt::print("\n{}\n{:<26} {:>9} {:>14} {:>14} {:>12} {:>18}\n", title, "", "frames/s",
             "ms per frame", "core-s/frame", "cores busy", "ms to OpenCV");
  nlohmann::json rows = nlohmann::json::array();
  rows.push_back(
      print_row(fmt::format("run, {}", settings.preset), ours, opencv, settings.threads));
  rows.push_back(print_row("OpenCV loop", opencv, opencv, settings.threads));
  nlohmann::json steps = nlohmann::json::object();
  fmt::print("processor ms per frame, last round with its warm-up:");
  for (const SequenceStage& step : report.processor) {
    const double seconds = step.seconds / report.frames;
    fmt::print("  {} {:.1f}", step.name, seconds * 1e3);
    steps[step.name] = seconds;
  }
  fmt::print("\n");
  return {{"title", title}, {"threads", settings.threads}, {"rows", rows}, {"steps", steps}};
}

int run_benchmark(int argc, char** argv) {
  CommandLine line(
      "A run from a side-by-side H.264 video to both maps as 16-bit PNG and a view as H.264, "
      "against the loop of an OpenCV user");
  Settings settings;
  line.size(settings.width, settings.height);
  line.option("--preset", settings.preset, "Preset of the run");
  line.number("--disparities", settings.disparities, "Candidate disparities");
  line.number("--frames", settings.frames, "Frames that are timed, after the warm-up");
  line.rounds(settings.rounds);
  line.threads(settings.threads);
  line.number("--in-flight", settings.in_flight, "Frames in flight; threads + 2 by default");
  line.option("--folder", settings.folder, "Keep the generated video here for the next run");
  line.json(settings.json);
  line.parse(argc, argv);
  const auto& names = names_of(MatchPreset{});
  const auto preset = std::ranges::find(names, settings.preset,
                                        [](const auto& named) { return std::string(named.first); });
  if (preset == names.end()) {
    line.refuse(fmt::format("--preset is '{}', expected a preset", settings.preset));
  }
  cv::setNumThreads(1);
  fmt::print("instruction set {}, {} threads\n", instruction_set_in_use(), settings.threads);
  const fs::path folder = settings.folder.value_or(fs::temp_directory_path() /
                                                   fmt::format("line_speed-{}", ::getpid()));
  fs::create_directories(folder);
  const nlohmann::json table = measure(settings, preset->second, folder);
  if (!settings.folder) {
    fs::remove_all(folder);
  }
  write_json(settings.json, table);
  return 0;
}

}  // namespace
}  // namespace vantage::perf

int main(int argc, char** argv) { return vantage::perf::run_benchmark(argc, argv); }
