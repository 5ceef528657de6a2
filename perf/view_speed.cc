// Speed of new views against two bicubic cv::remap calls for the same pixels in the same run, on
// one thread and on all: views between and beside the cameras, off the baseline, rotated and
// rolled; each with its own intensity fit and with a given one, as in movies. Prints a table;
// --json FILE writes the numbers.

#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <optional>
#include <string>
#include <vector>

#include "engine/io/images/photograph_io.h"
#include "engine/simd.h"
#include "engine/synthesis/view_synthesizer.h"
#include "perf/command_line.h"
#include "perf/figures.h"
#include "perf/stopwatch.h"
#include "perf/view_inputs.h"

namespace vantage::perf {
namespace {

struct Settings {
  int width = 1920;
  int height = 1080;
  bool is_grey = false;
  int rounds = 9;
  int threads = scheduler::detect_machine().hardware_threads;
  std::string only;  ///< substring of the names of the rows to run; empty: all
  std::optional<std::string> json;
  std::optional<std::string> pictures;  ///< output folder for all views
};

/// Views of one kind, and the cv::remap calls they are compared with.
class Row {
 public:
  Row(std::string name, const SyntheticPair& scene, const ViewPlace& place, TwoRemaps& remaps,
      const SynthesisOptions& options, bool is_fit_given,
      const std::array<Execution*, 2>& executions)
      : name_(std::move(name)),
        scene_(scene),
        geometry_(place.view(scene)),
        remaps_(remaps),
        synthesizers_{ViewSynthesizer(options, *executions[0]),
                      ViewSynthesizer(options, *executions[1])} {
    run(0);
    if (is_fit_given) {
      fit_ = view_.intensity;
    }
  }

  void run(std::size_t which_threads) {
    synthesizers_[which_threads].synthesize(
        {scene_.left, scene_.right, scene_.maps.left.disparity_px.view(),
         scene_.maps.right.disparity_px.view()},
        geometry_, view_, fit_ ? &*fit_ : nullptr);
  }

  // Times both close together, so that changes of the machine's speed affect both.
  void time_round(const std::array<int, 2>& threads) {
    for (std::size_t i = 0; i < threads.size(); ++i) {
      const Stopwatch ours;
      run(i);
      ours_[i].push_back(ours.per_frame(1));
      cv::setNumThreads(threads[i]);
      const Stopwatch fixed;
      remaps_.run_fixed();
      fixed_[i].push_back(fixed.per_frame(1));
      const Stopwatch with_floats;
      remaps_.run_float();
      float_[i].push_back(with_floats.per_frame(1));
    }
  }

  [[nodiscard]] nlohmann::json print() const {
    const auto median_ms = [](const std::vector<FrameTime>& rounds) {
      return 1e3 * median(of(rounds, &FrameTime::wall));
    };
    const auto processor_ms = [](const std::vector<FrameTime>& rounds) {
      return 1e3 * min(of(rounds, &FrameTime::processor));
    };
    const std::vector<double> speed_up = ratios(ours_[0], ours_[1]);
    const std::array<std::vector<double>, 2> to_fixed = {ratios(ours_[0], fixed_[0]),
                                                         ratios(ours_[1], fixed_[1])};
    const std::vector<double> to_float = ratios(ours_[1], float_[1]);
    const double processor_ratio = processor_ms(ours_[0]) / processor_ms(fixed_[0]);
    fmt::print(
        "{:<40} {:>7.1f} {:>7.1f} {:>7.1f} {:>7.1f} {:>16} {:>7.1f} {:>7.1f} {:>16} {:>7.2f}"
        " {:>7.2f}\n",
        name_, median_ms(ours_[0]), processor_ms(ours_[0]), median_ms(ours_[1]),
        processor_ms(ours_[1]), with_range(speed_up), median_ms(fixed_[0]), median_ms(fixed_[1]),
        with_range(to_fixed[1]), processor_ratio, median(to_float));
    return {{"name", name_},
            {"milliseconds", {median_ms(ours_[0]), median_ms(ours_[1])}},
            {"processor_milliseconds", {processor_ms(ours_[0]), processor_ms(ours_[1])}},
            {"speed_up", figures(speed_up)},
            {"two_remaps_milliseconds", {median_ms(fixed_[0]), median_ms(fixed_[1])}},
            {"two_float_remaps_milliseconds", {median_ms(float_[0]), median_ms(float_[1])}},
            {"ratio_to_two_remaps", {figures(to_fixed[0]), figures(to_fixed[1])}},
            {"processor_ratio_to_two_remaps", processor_ratio},
            {"ratio_to_two_float_remaps", figures(to_float)},
            {"hole_fraction", view_.hole_fraction}};
  }

  void write_pictures(const std::string& folder) const {
    write_photograph(folder + "/" + name_ + ".png", view_.image);
    for (const std::size_t side : {0, 1}) {
      cv::imwrite(fmt::format("{}/{}, remap {}.png", folder, name_, side), remaps_.remapped(side));
    }
  }

 private:
  std::string name_;
  const SyntheticPair& scene_;
  NewView geometry_;
  TwoRemaps& remaps_;
  std::array<ViewSynthesizer, 2> synthesizers_;
  std::optional<std::array<IntensityFit, 4>> fit_;
  SynthesizedView view_;
  // On one thread and on all.
  std::array<std::vector<FrameTime>, 2> ours_, fixed_, float_;
};

nlohmann::json compare(const Settings& settings) {
  const std::array<int, 2> threads = {1, settings.threads};
  Execution one({.threads = threads[0]});
  Execution all({.threads = threads[1]});
  const SyntheticPair scene =
      make_synthetic_pair(settings.width, settings.height, settings.is_grey, all);
  std::vector<std::unique_ptr<TwoRemaps>> remaps;
  std::vector<Row> rows;
  const auto add = [&](const std::string& name, const ViewPlace& place,
                       const SynthesisOptions& options) {
    for (const bool is_fit_given : {false, true}) {
      std::string full_name = name + (is_fit_given ? ", fit given" : "");
      if (full_name.find(settings.only) != std::string::npos) {
        rows.emplace_back(std::move(full_name), scene, place, *remaps.back(), options, is_fit_given,
                          std::array<Execution*, 2>{&one, &all});
      }
    }
  };
  for (const ViewPlace& place : view_places()) {
    remaps.push_back(std::make_unique<TwoRemaps>(scene, place));
    add(place.name, place, {});
    if (remaps.size() == 1) {
      add(place.name + ", hard edges", place, {.soft_edges = false});
      add(place.name + ", inpaint", place, {.holes = HoleFilling::kInpaint});
      add(place.name + ", texture", place, {.holes = HoleFilling::kTexture});
    }
  }
  for (int round = 0; round < settings.rounds; ++round) {
    for (Row& row : rows) {
      row.time_round(threads);
    }
  }
  const std::string title =
      fmt::format("{}x{}, {}, 8 bit, {} rounds", settings.width, settings.height,
                  settings.is_grey ? "grey" : "RGB", settings.rounds);
  const std::string all_ms = fmt::format("{}: ms", threads[1]);
  fmt::print("\n{}\n{:<40} {:>31} {:>16} {:>15} {:>32}\n", title, "threads: median ms, CPU ms",
             "a new view", "", "two cv::remap", "ratio to them: median (range)");
  fmt::print("{:<40} {:>7} {:>7} {:>7} {:>7} {:>16} {:>7} {:>7} {:>16} {:>7} {:>7}\n", "", "1: ms",
             "CPU", all_ms, "CPU", "speed-up", "1: ms", all_ms, fmt::format("{}", threads[1]),
             "1, CPU", "float");
  nlohmann::json result = nlohmann::json::array();
  for (const Row& row : rows) {
    result.push_back(row.print());
    if (settings.pictures) {
      row.write_pictures(*settings.pictures);
    }
  }
  return {{"title", title}, {"threads", threads}, {"rows", result}};
}

int run_benchmark(int argc, char** argv) {
  CommandLine line("New views against two bicubic cv::remap calls of the same pixels");
  Settings settings;
  line.size(settings.width, settings.height);
  line.flag("--grey", settings.is_grey, "Grey photographs");
  line.rounds(settings.rounds);
  line.threads(settings.threads);
  line.only(settings.only, "Only rows whose names contain this");
  line.option("--pictures", settings.pictures, "Write all views to this folder");
  line.json(settings.json);
  line.parse(argc, argv);
  fmt::print("instruction set {}, {} hardware threads\n", instruction_set_in_use(),
             scheduler::detect_machine().hardware_threads);
  const nlohmann::json table = compare(settings);
  write_json(settings.json, table);
  return 0;
}

}  // namespace
}  // namespace vantage::perf

int main(int argc, char** argv) { return vantage::perf::run_benchmark(argc, argv); }
