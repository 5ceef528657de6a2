#include "apps/settings/suggestions.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "engine/options/nearest_name.h"

namespace vantage::apps {
namespace {

/// An answer to words that other programs use.
struct WordAnswer {
  std::vector<std::string_view> words;
  std::string_view needs;  ///< option that a command must have for the answer to be true of it
  std::string_view answer;
};

const auto& option_answers() {
  static const std::array kAnswers = {
      WordAnswer{{"max-disp", "max-disparity", "maxdisp", "min-disp", "min-disparity", "mindisp",
                  "num-disparities", "num-disp", "ndisp", "numdisparities", "disp-range",
                  "disparity-range", "search-range"},
                 "--disparities",
                 "--disparities MIN:MAX is the range to search, both ends included"},
      WordAnswer{
          {"block-size", "blocksize", "window-size", "win-size", "sad-window", "kernel-size"},
          "--window",
          "--window PX is the side of the window of --method ssd; presets have no window"},
      WordAnswer{{"uniqueness", "uniqueness-ratio"},
                 "--confidence-threshold",
                 "--confidence-threshold X rejects uncertain pixels"},
      WordAnswer{{"speckle-window", "speckle-window-size", "speckle-range", "speckles"},
                 "--speckle-size",
                 "--speckle-size PX rejects small regions"},
      WordAnswer{
          {"disp12-max-diff", "max-diff", "lr-check", "left-right-check", "lrc", "consistency"},
          "--cross-check",
          "--cross-check PX compares the left map with the right one"},
      WordAnswer{{"p1", "p2", "smoothness"},
                 "--epsilon-prior",
                 "--epsilon-prior and --sigma-prior set the smoothness of maps"},
      WordAnswer{{"color", "colors", "use-color"},
                 "--colour",
                 "--colour luma|channels selects what is compared in colour images"},
      WordAnswer{{"colormap", "color-map", "colourmap", "colour-map", "cmap", "jet", "visualize"},
                 "--preview",
                 "--preview FILE writes the map in false colours; there is one colour scale"},
      WordAnswer{{"colormap", "color-map", "colourmap", "colour-map", "cmap", "jet", "visualize"},
                 "--sequence",
                 "--save preview writes the maps in false colours; there is one colour scale"},
      WordAnswer{
          {"stride", "skip", "nth", "subsample", "frame-step"},
          "--every",
          "--every N takes every Nth pair, --every 4s one pair every four seconds of a video, "
          "--frames A-B the frames from A to B"},
      WordAnswer{{"start", "end", "start-frame", "end-frame", "first-frame", "last-frame",
                  "num-frames", "frame-range", "from", "to"},
                 "--sequence",
                 "--frames A-B selects the frames from A to B, counted from 0"},
      WordAnswer{{"depth-map", "depthmap", "point-cloud", "pointcloud", "ply"},
                 "--depth",
                 "--depth FILE writes depths in metres, --cloud FILE.ply points, --mesh FILE.ply a "
                 "surface"},
      WordAnswer{
          {"depth", "depth-map", "depthmap", "cloud", "point-cloud", "pointcloud", "ply", "mesh"},
          "--save",
          "--save depth,cloud,mesh writes depths in metres, points and a surface of each frame"},
      WordAnswer{
          {"depth", "depth-map", "depthmap", "cloud", "point-cloud", "pointcloud", "ply", "mesh"},
          "--disparities",
          "'vantage match --depth FILE' and 'vantage reproject' write depths in metres, with "
          "--cloud points"},
      WordAnswer{{"resize", "downscale", "downsample", "resolution"},
                 "--scale",
                 "--scale 0.5 matches images of half the size"},
      WordAnswer{{"jobs", "cores", "workers", "nproc", "cpus", "num-threads", "nthreads", "j"},
                 "--threads",
                 "--threads N is the number of threads"},
      WordAnswer{{"gpu", "cuda", "device", "opencl"},
                 "--threads",
                 "all work runs on the processor, on --threads N"},
      WordAnswer{{"verbose", "debug", "v", "log-level"},
                 "--report",
                 "messages are printed without --quiet; --report FILE writes all figures"},
      WordAnswer{{"no-submit"}, "--go", "without --go scripts are only written"},
      WordAnswer{{"slurm-memory"}, "--task-memory", "it is now --task-memory"},
      WordAnswer{{"silent", "q"}, "--quiet", "--quiet prints errors only"},
      WordAnswer{
          {"out", "outfile", "out-dir", "outdir", "output-dir", "output-file", "output-folder"},
          "--output",
          "-o or --output is the path to the results"},
      WordAnswer{{"algorithm", "algo", "matcher", "mode", "sgbm", "bm", "realtime", "fast",
                  "balanced", "quality", "best"},
                 "--preset",
                 "--preset realtime|balanced|quality selects how pairs are matched"},
      WordAnswer{{"calib", "camera", "cameras", "intrinsics", "extrinsics"},
                 "--calibration",
                 "--calibration FILE is the path to the cameras"},
      WordAnswer{{"version"}, "", "'vantage --version' prints the version"},
  };
  return kAnswers;
}

const auto& command_answers() {
  static const std::array kAnswers = {
      WordAnswer{{"disparity", "disparities", "stereo", "disp", "sgbm", "sgm", "bm", "compute",
                  "matching"},
                 "",
                 "'vantage match' computes disparity maps"},
      WordAnswer{
          {"depth", "depthmap", "depth-map", "cloud", "pointcloud", "point-cloud", "mesh"},
          "",
          "'vantage match --depth FILE' writes depths of a pair in metres (--cloud: points), "
          "'vantage reproject' those of a disparity map"},
      WordAnswer{{"calibrate", "calibration", "undistort", "align"},
                 "",
                 "'vantage rectify' estimates cameras and rectifies photographs"},
      WordAnswer{{"render", "synthesis", "synthesize", "synthesise", "interpolate", "novel-view"},
                 "",
                 "'vantage synth' renders new views of a pair"},
      WordAnswer{{"video", "movie", "sequence", "batch", "process"},
                 "",
                 "'vantage run' computes maps and views of sequences and videos"},
      WordAnswer{{"viewer", "html", "web", "show", "display"},
                 "",
                 "'vantage view' writes a page that shows new views in a browser"},
      WordAnswer{{"evaluate", "evaluation", "compare", "metrics", "score", "error", "psnr"},
                 "",
                 "'vantage eval' compares a map or a view with the truth"},
      WordAnswer{{"benchmark", "bench", "perf", "time"},
                 "",
                 "'vantage profile' shows where the time of match or run goes"},
      WordAnswer{{"slurm", "cluster", "sbatch", "kubernetes", "sge", "qsub", "aws"},
                 "",
                 "'vantage submit' runs a batch, or one sequence, on a cluster"},
      WordAnswer{{"join", "concat"}, "", "'vantage merge' joins the parts of a run"},
      WordAnswer{{"resume", "continue"}, "", "'vantage run --resume' continues a run"},
      WordAnswer{{"experiment"}, "", "it is now 'vantage book figure'"},
      WordAnswer{{"response"}, "", "'vantage book figure 5.4 5.5' computes gradient evidence"},
      WordAnswer{{"generate"},
                 "",
                 "'vantage generate scene' renders artificial scenes; 'generate book' is now "
                 "'vantage book pair'"},
      WordAnswer{{"version"}, "", "'vantage --version' prints the version"},
      WordAnswer{{"commands", "list", "usage"}, "", "'vantage help' lists the commands"},
  };
  return kAnswers;
}

template <typename Answers>
std::string_view answer_to(std::string_view word, const Answers& all,
                           const std::vector<std::string>& known) {
  for (const WordAnswer& one : all) {
    const bool is_true = one.needs.empty() || std::ranges::find(known, without_dashes(one.needs),
                                                                without_dashes) != known.end();
    if (is_true && std::ranges::find(one.words, word) != one.words.end()) {
      return one.answer;
    }
  }
  return "";
}

template <typename Answers>
std::string hint(const std::string& name, const Answers& words,
                 const std::vector<std::string>& known, std::string_view list) {
  if (const std::string_view answer = answer_to(without_dashes(name), words, known);
      !answer.empty()) {
    return fmt::format(": {}", answer);
  }
  if (const std::string nearest = nearest_name(name, known); !nearest.empty()) {
    return fmt::format(", the nearest known one is '{}'", nearest);
  }
  return fmt::format("; '{}' lists all", list);
}

}  // namespace

std::string hint_for_option(const std::string& command, const std::string& name,
                            const std::vector<std::string>& known) {
  return hint(name, option_answers(), known, fmt::format("vantage {} --help-all", command));
}

std::string hint_for_command(const std::string& name, const std::vector<std::string>& known) {
  return hint(name, command_answers(), known, "vantage help");
}

}  // namespace vantage::apps
