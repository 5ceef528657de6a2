// Speed of the whole line: a film of photographs in, H.264 side by side; both maps as 16-bit PNG
// and a view as H.264 out. Beside it the loop of an OpenCV user, interleaved in one run. Prints
// frames/s, core-seconds and what each step costs; --json FILE writes the numbers.

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "engine/matching/options/method_names.h"
#include "engine/simd.h"
#include "perf/command_line.h"
#include "perf/default_paths.h"
#include "perf/figures.h"
#include "perf/photograph_film.h"
#include "perf/sequence_inputs.h"
#include "perf/sequence_timing.h"

namespace vantage::perf {
namespace {

namespace fs = std::filesystem;

constexpr int kFilmFrames = 48;
/// A chunk is longer than a run, so that its videos end after the clock.
constexpr int kChunkFrames = 1000;

/// What is made of each frame.
enum class Results { kMapsAndView, kMaps, kDepthFilm };
const std::map<std::string, Results> kResults = {{"maps-and-view", Results::kMapsAndView},
                                                 {"maps", Results::kMaps},
                                                 {"depth-film", Results::kDepthFilm}};

struct Settings {
  int width = 1920;
  int height = 1080;
  int disparities = 192;
  std::string preset = "realtime";
  std::string results = "maps-and-view";
  int frames = 40;  ///< after the warm-up
  int rounds = 3;
  int threads = scheduler::detect_machine().hardware_threads;
  std::optional<int> in_flight;
  std::optional<fs::path> film;
  std::vector<fs::path> pair;
  std::optional<std::string> json;
};

/// The film that is given, or one of the pair that is given or at hand.
SequenceInputs find_film(const Settings& settings, const fs::path& folder) {
  SequenceInputs inputs;
  if (settings.film) {
    inputs.name = settings.film->filename();
    inputs.video_file = *settings.film;
  } else {
    const fs::path photograph = fs::path(kDefaultData) / "motorcycle";
    const FilmedPair pair = !settings.pair.empty()
                                ? read_pair(settings.pair.at(0), settings.pair.at(1))
                            : fs::exists(photograph / "im0.png")
                                ? read_pair(photograph / "im0.png", photograph / "im1.png")
                                : generated_pair();
    inputs.name = pair.name;
    inputs.video_file = folder / "film.mp4";
    write_film(pair, {settings.width, settings.height}, kFilmFrames, inputs.video_file);
  }
  inputs.video.stereo = inputs.video_file.string();
  inputs.video.packing = StereoPacking{};
  return inputs;
}

SequenceOptions line_options(const Settings& settings, MatchPreset preset) {
  SequenceOptions options;
  options.match.preset = preset;
  options.match.disparities = {0, settings.disparities - 1};
  options.map_format = "png";
  options.chunk_frames = kChunkFrames;
  switch (kResults.at(settings.results)) {
    case Results::kMaps:
      options.save = {SequenceOutput::kDisparity, SequenceOutput::kRightDisparity};
      break;
    case Results::kDepthFilm:
      options.save = {SequenceOutput::kDepthVideo};
      break;
    case Results::kMapsAndView:
      options.save = {SequenceOutput::kDisparity, SequenceOutput::kRightDisparity,
                      SequenceOutput::kViews};
      options.video = {SequenceOutput::kViews};
      options.views = {ViewPath::fixed(BaselinePosition{0.5, 0})};
  }
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
  const SequenceInputs inputs = find_film(settings, folder);
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
  const std::string title = fmt::format(
      "film of {}, {}; {} candidates, {} threads, {} frames of {} rounds", inputs.name,
      settings.results, settings.disparities, settings.threads, settings.frames, settings.rounds);
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
      "A run from a side-by-side film of photographs to both maps as 16-bit PNG and a view as "
      "H.264, against the loop of an OpenCV user: one map of StereoSGBM three-way as PNG");
  Settings settings;
  line.option("--film", settings.film, "Film, side by side; replaces --pair and --size");
  line.option("--pair", settings.pair,
              "LEFT RIGHT: photographs that a film is made of; Middlebury's motorcycle where it is "
              "at hand, else a generated scene");
  line.size(settings.width, settings.height, "Size of each image of the film that is made");
  line.choice("--results", settings.results, kResults, "What is made of each frame");
  line.option("--preset", settings.preset, "Preset of the run");
  line.number("--disparities", settings.disparities, "Candidate disparities");
  line.number("--frames", settings.frames, "Frames that are timed, after the warm-up");
  line.rounds(settings.rounds);
  line.threads(settings.threads);
  line.number("--in-flight", settings.in_flight, "Frames in flight; threads + 2 by default");
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
  if (!settings.pair.empty() && settings.pair.size() != 2) {
    line.refuse("--pair takes two photographs, the left one first");
  }
  const fs::path folder = fs::temp_directory_path() / fmt::format("line_speed-{}", ::getpid());
  fs::create_directories(folder);
  const nlohmann::json table = measure(settings, preset->second, folder);
  fs::remove_all(folder);
  write_json(settings.json, table);
  return 0;
}

}  // namespace
}  // namespace vantage::perf

int main(int argc, char** argv) { return vantage::perf::run_benchmark(argc, argv); }
