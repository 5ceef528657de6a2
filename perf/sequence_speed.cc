// Speed of sequences: time per frame without reading and writing, sustained rate of a run from
// files to files, and a typical OpenCV user's loop, all interleaved in one run. Prints tables;
// --json FILE writes the numbers.

#include <fmt/format.h>
#include <unistd.h>

#include <cstdlib>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "engine/matching/stereo_matcher.h"
#include "engine/simd.h"
#include "engine/synthesis/view_synthesizer.h"
#include "perf/command_line.h"
#include "perf/default_paths.h"
#include "perf/figures.h"
#include "perf/sequence_inputs.h"
#include "perf/sequence_timing.h"
#include "perf/stopwatch.h"

namespace vantage::perf {
namespace {

namespace fs = std::filesystem;

constexpr DisparityRange kRange = {0, 79};
constexpr double kViewX = 0.5;
/// Videos are delivered in chunks.
constexpr int kChunkFrames = 50;
constexpr int kVideoFrames = 2 * kChunkFrames + kWarmUpFrames;

/// One way to process a sequence; returns the time per frame.
struct Contender {
  std::string name;
  std::function<FrameTime()> run;
  std::vector<FrameTime> rounds = {};
};

struct Method {
  std::string name;
  MatchOptions match;
  int frames;  ///< per run, warm-up included
  /// Also time views as video; omitted where frames take so long that encoding does not matter.
  bool with_video = false;
};

std::vector<Method> all_methods() {
  std::vector<Method> methods(3);
  methods[0] = {.name = "ssd", .match = {}, .frames = 144, .with_video = true};
  methods[0].match.method = MatchMethod::kSsd;
  methods[1] = {.name = "preset balanced", .match = {}, .frames = 60};
  methods[1].match.preset = MatchPreset::kBalanced;
  methods[2] = {.name = "bayes", .match = {}, .frames = 36};
  methods[2].match.method = MatchMethod::kBayes;
  for (Method& method : methods) {
    method.match.disparities = kRange;
  }
  return methods;
}

SequenceOptions run_options(const Method& method, bool views_as_video) {
  SequenceOptions options;
  options.match = method.match;
  options.save = {SequenceOutput::kDisparity, SequenceOutput::kRightDisparity,
                  SequenceOutput::kViews};
  if (views_as_video) {
    options.video = {SequenceOutput::kViews};
  }
  options.views = {ViewPath::fixed(BaselinePosition{kViewX, 0})};
  options.chunk_frames = kChunkFrames;
  return options;
}

/// The computation of a run between reading and writing, on pairs in memory.
class Computation {
 public:
  Computation(const Method& method, int threads)
      : execution_({.threads = threads}),
        matcher_(method.match, execution_),
        synthesizer_(SynthesisOptions{}, execution_) {}

  void work(const FramePair& pair) {
    const auto results = results_.borrow();
    matcher_.match(pair.left, pair.right, {}, results->maps);
    synthesizer_.synthesize({pair.left, pair.right, results->maps.left.disparity_px.view(),
                             results->maps.right.disparity_px.view()},
                            kViewX, results->view);
  }

  /// Processes frames one after another, or as many at a time as there are threads.
  FrameTime work(const std::vector<FramePair>& pairs) {
    const Stopwatch watch;
    const int count = static_cast<int>(pairs.size());
    execution_.executor().parallel_for(
        count, [&](int pair) { work(pairs[static_cast<std::size_t>(pair)]); });
    return watch.per_frame(count);
  }

 private:
  struct Results {
    DisparityMaps maps;
    SynthesizedView view;
  };

  Execution execution_;
  StereoMatcher matcher_;
  ViewSynthesizer synthesizer_;
  ObjectPool<Results> results_;
};

std::vector<FramePair> decode_pairs(const PairSourceOptions& input, int count) {
  const auto source = open_pair_source(input);
  std::vector<FramePair> pairs(static_cast<std::size_t>(std::min(count, source->pair_count())));
  for (FramePair& pair : pairs) {
    source->fetch(pair);
    source->decode(pair);
  }
  return pairs;
}

/// Runs all in turn, so that changes of the machine's speed affect all of them.
void run_interleaved(std::vector<Contender>& contenders, int rounds) {
  for (Contender& contender : contenders) {
    contender.run();
  }
  for (int round = 0; round < rounds; ++round) {
    for (Contender& contender : contenders) {
      contender.rounds.push_back(contender.run());
    }
  }
}

/// Rate of `contender` relative to all cores together, if each took `reference`'s time per frame;
/// median over rounds.
double median_efficiency(const Contender& reference, const Contender& contender, int cores) {
  return median(ratios(reference.rounds, contender.rounds)) / cores;
}

/// The first contender is the time per frame of one thread without reading and writing.
nlohmann::json print_table(const std::string& title, const std::vector<Contender>& contenders,
                           const Contender& peer, int cores) {
  fmt::print("\n{}\n{:<38} {:>9} {:>9} {:>9} {:>9} {:>10} {:>10}\n", title, "", "least ms",
             "median ms", "CPU ms", "frames/s", "efficiency", "to OpenCV");
  nlohmann::json rows = nlohmann::json::array();
  const auto row = [&](const Contender& contender) {
    const std::vector<double> wall = of(contender.rounds, &FrameTime::wall);
    const double processor = min(of(contender.rounds, &FrameTime::processor));
    const double efficiency = median_efficiency(contenders.front(), contender, cores);
    const double ratio = median(wall) / median(of(peer.rounds, &FrameTime::wall));
    fmt::print("{:<38} {:>9.2f} {:>9.2f} {:>9.2f} {:>9.1f} {:>10.3f} {:>10.3f}\n", contender.name,
               min(wall) * 1e3, median(wall) * 1e3, processor * 1e3, 1 / median(wall), efficiency,
               ratio);
    rows.push_back({{"name", contender.name},
                    {"least_seconds", min(wall)},
                    {"median_seconds", median(wall)},
                    {"processor_seconds", processor},
                    {"efficiency", efficiency},
                    {"ratio_to_opencv", ratio}});
  };
  for (const Contender& contender : contenders) {
    row(contender);
  }
  row(peer);
  return {{"title", title}, {"rows", rows}};
}

struct Settings {
  std::optional<std::string> json;
  fs::path input = fs::path(kDefaultData) / "kitti_seq1";
  fs::path output = fs::temp_directory_path();
  int rounds = 5;
  int threads = scheduler::detect_machine().hardware_threads;
  std::optional<int> in_flight;
  std::string only;  ///< name of a method; empty: all
};

nlohmann::json time_input(const SequenceInputs& inputs, bool from_video, const Settings& settings,
                          const fs::path& folder) {
  const PairSourceOptions& input = from_video ? inputs.video : inputs.images;
  const int in_flight = settings.in_flight.value_or(settings.threads + 2);
  const std::string form = from_video ? "packed MP4" : "PNG pairs";
  const std::vector<FramePair> pairs = decode_pairs(input, 8);
  std::vector<std::unique_ptr<Computation>> computations;
  std::vector<Contender> contenders;
  struct Group {
    std::string name;
    std::size_t begin;
    std::size_t end;
  };
  std::vector<Group> groups;
  for (const Method& method : all_methods()) {
    if (!settings.only.empty() && settings.only != method.name) {
      continue;
    }
    const std::size_t begin = contenders.size();
    for (const int threads : {1, settings.threads}) {
      computations.push_back(std::make_unique<Computation>(method, threads));
      contenders.push_back(
          {threads == 1 ? "computing alone, 1 thread"
                        : fmt::format("computing alone, {} frames at a time", threads),
           [&pairs, computation = computations.back().get()] { return computation->work(pairs); }});
    }
    contenders.push_back({form + " to PFM and PNG", [&, method] {
                            return time_run(input, run_options(method, false), method.frames,
                                            settings.threads, in_flight, folder / "run")
                                .frame;
                          }});
    if (method.with_video) {
      contenders.push_back({form + " to PFM and MP4", [&, method] {
                              return time_run(input, run_options(method, true), kVideoFrames,
                                              settings.threads, in_flight, folder / "run")
                                  .frame;
                            }});
    }
    groups.push_back({method.name, begin, contenders.size()});
  }
  contenders.push_back({"OpenCV StereoSGBM loop", [&, from_video] {
                          return time_opencv(inputs, kRange, from_video, 13, settings.threads,
                                             folder / "opencv");
                        }});
  run_interleaved(contenders, settings.rounds);
  nlohmann::json tables = nlohmann::json::array();
  for (const Group& group : groups) {
    const std::vector<Contender> rows(contenders.begin() + static_cast<std::ptrdiff_t>(group.begin),
                                      contenders.begin() + static_cast<std::ptrdiff_t>(group.end));
    tables.push_back(print_table(fmt::format("{}, {}: {}", inputs.name, form, group.name), rows,
                                 contenders.back(), settings.threads));
  }
  return tables;
}

std::optional<SequenceInputs> find_inputs(const fs::path& folder) {
  if (!fs::is_directory(folder / "left") || !fs::is_directory(folder / "right")) {
    return std::nullopt;
  }
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() == ".mp4") {
      return sequence_inputs(folder.filename().string(), folder / "left", folder / "right",
                             entry.path());
    }
  }
  return std::nullopt;
}

int run_benchmark(int argc, char** argv) {
  CommandLine line(
      "Runs from files to files against their computing time and against the loop of an OpenCV "
      "user");
  Settings settings;
  line.option("FOLDER", settings.input,
              "Folder with left/, right/ and a packed .mp4; without it a sequence is generated");
  line.rounds(settings.rounds);
  line.threads(settings.threads);
  line.number("--in-flight", settings.in_flight, "Frames in flight; threads + 2 by default");
  line.only(settings.only, "Only this method: ssd, preset balanced, bayes");
  line.option("--output", settings.output, "Folder of the temporary results");
  line.json(settings.json);
  line.parse(argc, argv);
  cv::setNumThreads(1);
  fmt::print("instruction set {}, {} threads\n", instruction_set_in_use(), settings.threads);
  const fs::path folder = settings.output / fmt::format("sequence_speed-{}", ::getpid());
  fs::create_directories(folder);
  std::optional<SequenceInputs> inputs = find_inputs(settings.input);
  if (!inputs) {
    fmt::print("no sequence in {}: a generated one is used\n", settings.input.string());
    inputs = generate_sequence(folder / "input");
  }
  nlohmann::json tables = nlohmann::json::array();
  for (const bool from_video : {false, true}) {
    for (auto& table : time_input(*inputs, from_video, settings, folder)) {
      tables.push_back(std::move(table));
    }
  }
  fs::remove_all(folder);
  write_json(settings.json, tables);
  return 0;
}

}  // namespace
}  // namespace vantage::perf

int main(int argc, char** argv) { return vantage::perf::run_benchmark(argc, argv); }
